// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "components/report/flight_story.hpp"

/// The parts of a report that are text and tables, as HTML. Each says what the recording does not
/// have.
namespace swiftlet {

std::string header_html(const FlightStory& story);
std::string figures_html(const FlightStory& story);
std::string events_html(const FlightStory& story);
std::string sensors_html(const FlightStory& story);
std::string estimator_html(const FlightStory& story);
/// Topics with what was lost of them, the files, the run and what is wrong with the recording.
std::string recording_html(const FlightStory& story);

}  // namespace swiftlet
