// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "components/report/flight_story.hpp"
#include "estimation/basics/result.hpp"

namespace swiftlet {

/// The story as one HTML page that needs nothing else: style, script, data and map are in it, and
/// its content security policy lets a browser load nothing and run no other script.
std::string report_page(const FlightStory& story);

/// Writes the page beside the file and puts it in its place when it is whole.
Status write_report(const FlightStory& story, const std::filesystem::path& file);

}  // namespace swiftlet
