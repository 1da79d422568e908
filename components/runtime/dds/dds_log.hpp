// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace swiftlet {

/// From now on, what Fast DDS has to say goes to our log, not to standard output.
void bridge_dds_log();

}  // namespace swiftlet
