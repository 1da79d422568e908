// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "swiftlet_msgs.h"

namespace swiftlet {

using ParameterReplies = std::vector<swiftlet_msgs::msg::ParameterReply>;

/// A block an instance, a line a parameter: name, value, type, limits, when it may be set.
std::string parameters_text(const ParameterReplies& replies);
nlohmann::ordered_json parameters_json(const ParameterReplies& replies);

/// A file for `--params`: a section a component, dotted names as mappings. Of several instances of
/// a component the first counts; `differing` names components whose instances do not agree.
std::string parameters_yaml(const ParameterReplies& replies, std::vector<std::string>& differing);

}  // namespace swiftlet
