// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/verdict.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

