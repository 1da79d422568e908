// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/wind.hpp"

namespace swiftlet {

Wind::Wind(const Params& params, RandomStream random)
    : params_(params),
      random_(random),
      gust_(params.gust_intensity.cwiseProduct(random_.normal3())) {}

void Wind::step(Duration dt) {
  if (params_.gust_intensity.isZero(0.0)) return;
  gust_ = gauss_markov_step(gust_, params_.gust_intensity, params_.gust_time_constant,
                            to_seconds(dt), random_.normal3());
}

}  // namespace swiftlet
