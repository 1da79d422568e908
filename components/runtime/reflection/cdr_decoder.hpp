// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "components/runtime/message.hpp"
#include "components/runtime/reflection/value.hpp"

namespace swiftlet {

/// The value that the bytes hold: CDR as ROS 2 uses it (XCDR version 1), in either byte order, with
/// the four bytes of encapsulation in front. Bytes may come from anybody: what does not fit is an
/// error that names the field, and no length is believed before the bytes for it are there. Up to
/// three bytes of padding may follow.
Result<Value> decode(const TypeDescription& type, const Cdr& cdr);

}  // namespace swiftlet
