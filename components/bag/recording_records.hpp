// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names of the metadata records with which a recording speaks of itself. (That of losses is in
/// loss_ledger.hpp.)
namespace swiftlet {

/// About the run, first in each file: start_ns on the clock of the run, vehicle, domain, lockstep,
/// version, and what the program that records adds.
inline constexpr const char* kRunRecord = "swiftlet_run";
inline constexpr const char* kRunStartKey = "start_ns";
/// Of a flight: names of the components, in the order in which they were made.
inline constexpr const char* kRunComponentsKey = "components";
/// Of a flight: all parameters that were used, as a YAML file with a section for each component.
inline constexpr const char* kRunParametersKey = "parameters";

/// In the metadata of a channel: the component that wrote its messages. A topic that several
/// components write has a channel for each.
inline constexpr const char* kChannelComponentKey = "component";

/// Of a file that begins with samples from before its beginning: "part" with its place among the
/// files of a split recording, and "repeated/<topic>" with the sequence numbers of those samples.
/// Whoever reads the files as one leaves those out.
inline constexpr const char* kPartRecord = "swiftlet_part";
inline constexpr const char* kRepeatedKey = "repeated/";

/// Of a file that was repaired: what could not be saved.
inline constexpr const char* kRepairRecord = "swiftlet_repair";

}  // namespace swiftlet
