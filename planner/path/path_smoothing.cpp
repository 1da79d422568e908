// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "planner/path/path_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet {

double polyline_cost(const ClearanceMap& map, const Polyline& line) {
  double cost = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) cost += map.segment_cost(line[i], line[i + 1]);
  return cost;
}

Polyline shortcut(const ClearanceMap& map, const Polyline& line, double price_per_point,
                  int max_reach) {
  const std::size_t n = line.size();
  if (n < 3) return line;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> cost(n, kInfinity);  // from a point to the end
  std::vector<std::size_t> next(n, n - 1);
  cost[n - 1] = 0.0;
  for (std::size_t i = n - 1; i-- > 0;) {
    const std::size_t reach = std::min(n - 1, i + static_cast<std::size_t>(std::max(1, max_reach)));
    for (std::size_t j = i + 1; j <= reach; ++j) {
      // No metre costs less than one.
      if ((line[j] - line[i]).norm() + price_per_point + cost[j] >= cost[i]) continue;
      const double through = map.segment_cost(line[i], line[j]) + price_per_point + cost[j];
      if (through < cost[i]) {
        cost[i] = through;
        next[i] = j;
      }
    }
  }
  if (cost[0] == kInfinity) return line;
  Polyline result{line[0]};
  for (std::size_t i = 0; i != n - 1; i = next[i]) result.push_back(line[next[i]]);
  return result;
}

Polyline thin(const ClearanceMap& map, const Polyline& line, double spacing) {
  if (line.size() < 3) return line;
  Polyline result{line[0]};
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d& next = line[i + 1];
    if ((next - result.back()).norm() > spacing ||
        !std::isfinite(map.segment_cost(result.back(), next))) {
      result.push_back(line[i]);
    }
  }
  result.push_back(line.back());
  return result;
}

Polyline resample(const Polyline& line, double spacing) {
  if (line.empty()) return {};
  Polyline result{line[0]};
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d leg = line[i + 1] - line[i];
    const int pieces = std::max(1, static_cast<int>(std::ceil(leg.norm() / spacing)));
    for (int k = 1; k < pieces; ++k) {
      result.push_back(line[i] + leg * (static_cast<double>(k) / pieces));
    }
    result.push_back(line[i + 1]);
  }
  return result;
}

void relax(const ClearanceMap& map, Polyline& line, int rounds) {
  if (line.size() < 3) return;
  double step = 4.0 * map.resolution();
  for (int round = 0; round < rounds; ++round, step *= 0.5) {
    for (int sweep = 0; sweep < 4; ++sweep) {
      bool moved = false;
      for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        const Eigen::Vector2d along = line[i + 1] - line[i - 1];
        const double length = along.norm();
        if (!(length > 1e-9)) continue;
        const Eigen::Vector2d across(-along.y() / length, along.x() / length);
        const auto cost = [&](const Eigen::Vector2d& point) {
          return map.segment_cost(line[i - 1], point) + map.segment_cost(point, line[i + 1]);
        };
        double best = cost(line[i]);
        const Eigen::Vector2d candidates[] = {line[i] + step * across, line[i] - step * across};
        for (const Eigen::Vector2d& candidate : candidates) {
          const double candidate_cost = cost(candidate);
          // Without a real gain, the point would wander between equals.
          if (candidate_cost < best - 1e-9) {
            best = candidate_cost;
            line[i] = candidate;
            moved = true;
            break;
          }
        }
      }
      if (!moved) break;
    }
  }
}

}  // namespace swiftlet
