// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/qos.hpp"

namespace swiftlet {

std::string qos_conflict(const QosProfile& offered, const QosProfile& requested) {
  if (requested.reliable && !offered.reliable) {
    return "reliability: offered best effort, requested reliable";
  }
  if (requested.transient_local && !offered.transient_local) {
    return "durability: offered volatile, requested transient local";
  }
  return "";
}

}  // namespace swiftlet
