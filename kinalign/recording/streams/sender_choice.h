// SPDX-License-Identifier: Apache-2.0
// Which of several senders of a stream is the device, and what is said of the others.
#pragma once

#include "kinalign/recording/streams/device_rows.h"
#include "kinalign/recording/streams/sender_roll.h"
#include "kinalign/recording/survey.h"

#include <string>
#include <vector>

namespace kinalign {

/// Whom to listen to, in this order until rows can be made of one: those with most messages come
/// first, of an address without those that speak beside a busier one.
std::vector<DeviceChoice> choices(const DeviceChoice& wished, const SenderRoll& senders);

/// Of the chosen one no rows could be made: with the names of all.
Error with_senders(Error error, const std::string& chosen, const SenderRoll& senders);

/// A recording has several nodes of the stream and none was asked for: with lines of a manifest
/// that ask for one, or for all. Any other error as it is.
Error with_nodes(const DeviceWish& wish, const RecordingSurvey& survey, Error error);

/// That there are others than the ones that are read. `any_sender`: nobody asked for one.
Findings judge_senders(const DeviceWish& wish, bool any_sender, const SenderRoll& senders);

}  // namespace kinalign
