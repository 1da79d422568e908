// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/bag/recording.hpp"
#include "components/report/flight_story.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// Reads the whole recording once, in memory that does not grow with its length, and tells what
/// happened. Whatever topics it has will do; those that are damaged, of another type or not CDR are
/// left out and said in RecordingFacts::remarks.
///
/// Messages count at the time of their header, which is when they were true; one whose header says
/// none, or a time that is more than a second from when it was recorded, counts when it was
/// recorded.
///
/// `vehicle`: of which vehicle, where the recording has several (topics `uav1/odometry`); "" where
/// it has one. Fails where the recording holds no message, and where it is not clear which vehicle
/// is meant.
Result<FlightStory> read_story(const Recording& recording, const std::string& vehicle = "");

}  // namespace swiftlet
