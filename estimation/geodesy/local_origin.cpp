// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "estimation/geodesy/local_origin.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {
namespace {

constexpr double kHighest = 1e5;          // [m]
constexpr double kNarrowestSigma = 1e-3;  // that a receiver can claim [m]

GeographicLib::LocalCartesian plane_at(const GlobalPosition& origin) {
  return {origin.latitude, origin.longitude, origin.altitude};
}

}  // namespace

bool GlobalPosition::usable() const {
  return std::abs(latitude) <= 90.0 && std::abs(longitude) <= 360.0 &&
         std::abs(altitude) <= kHighest;
}

Eigen::Vector3d LocalOrigin::to_map(const GlobalPosition& place) const {
  Eigen::Vector3d p_W;
  plane_at(origin_).Forward(place.latitude, place.longitude, place.altitude, p_W.x(), p_W.y(),
                            p_W.z());
  return p_W;
}

GlobalPosition LocalOrigin::to_global(const Eigen::Vector3d& p_W) const {
  GlobalPosition place;
  plane_at(origin_).Reverse(p_W.x(), p_W.y(), p_W.z(), place.latitude, place.longitude,
                            place.altitude);
  return place;
}

void OriginEstimate::add(const GlobalPosition& fix, double sigma, const Eigen::Vector3d& p_WB) {
  if (!fix.usable() || !p_WB.allFinite() || !(sigma >= 0.0 && std::isfinite(sigma))) return;
  if (!first_) first_.emplace(fix);
  const double weight = 1.0 / std::pow(std::max(sigma, kNarrowestSigma), 2);
  information_ = information_ * (1.0 - 1.0 / params_.memory) + weight;
  mean_ += (first_->to_map(fix) - p_WB - mean_) * (weight / information_);
}

double OriginEstimate::sigma() const {
  return information_ > 0.0 ? 1.0 / std::sqrt(information_)
                            : std::numeric_limits<double>::infinity();
}

std::optional<LocalOrigin> OriginEstimate::origin() const {
  if (!(sigma() <= params_.good_sigma)) return std::nullopt;
  return LocalOrigin(first_->to_global(mean_));
}

}  // namespace swiftlet
