// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/reader.h"
