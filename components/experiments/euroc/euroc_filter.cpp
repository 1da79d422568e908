// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/estimator/estimator_params.hpp"
#include "components/experiments/data_table.hpp"
#include "components/experiments/euroc/euroc.hpp"
#include "components/experiments/euroc/motion_log.hpp"
#include "components/experiments/flight/flight_errors.hpp"
#include "components/experiments/seed_000.hpp"
#include "components/experiments/shared_file.hpp"
#include "components/sim/sensors/phone_pose.hpp"
#include "estimation/ukf/delayed_ukf.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using seed_000::kAxes;
using seed_000::kFilterVelocity;

/// Until the filter has found the biases of an IMU that it knows nothing of [s].
constexpr double kSettle_s = 10.0;
constexpr std::size_t kImuColumns = 7;

struct ImuRecord {
  Time time;
  ImuSample sample;
};

/// One recorded flight.
struct Sequence {
  std::string name;
  std::vector<ImuRecord> imu;
  MotionLog truth;
};

Result<std::vector<ImuRecord>> read_imu(const std::filesystem::path& file) {
  const auto table = read_table(file);
  if (!table) return table.error();
  if (table->front().size() != kImuColumns) {
    return Error{
        fmt::format("{}: {} columns; an IMU has 7 (nanoseconds, angular velocity, specific "
                    "force)",
                    file.string(), table->front().size())};
  }
  std::vector<ImuRecord> records;
  for (const std::vector<double>& row : *table) {
    records.push_back({Time(std::chrono::microseconds(std::llround(row[0] / 1e3))),
                       {{row[1], row[2], row[3]}, {row[4], row[5], row[6]}}});
  }
  return records;
}

/// The truth beside an IMU file: the one with velocities where there is one, which in EuRoC is the
/// one that was corrected.
Result<MotionLog> read_truth(const std::filesystem::path& folder) {
  for (const char* pattern :
       {R"(.*(gt|groundtruth).*\.csv(\.gz)?)", R"(.*(gt|groundtruth).*\.(txt|tum)(\.gz)?)"}) {
    const auto files = find_files(folder, pattern);
    if (!files.empty()) return MotionLog::read(files.front());
  }
  return Error{
      fmt::format("{}: an IMU without ground truth (gt*.csv or gt*.txt)", folder.string())};
}

Result<std::vector<Sequence>> read_sequences(const std::filesystem::path& folder) {
  std::vector<Sequence> sequences;
  for (const auto& file : find_files(folder, R"(imu.*\.csv(\.gz)?)")) {
    auto imu = read_imu(file);
    if (!imu) return imu.error();
    auto truth = read_truth(file.parent_path());
    if (!truth) return truth.error();
    sequences.push_back(
        {file.parent_path().filename().string(), *std::move(imu), *std::move(truth)});
  }
  if (sequences.empty()) {
    return Error{fmt::format("{}: no imu*.csv or imu*.csv.gz in it or below", folder.string())};
  }
  return sequences;
}

/// A moment of the filter, and of the phone where it has just spoken.
struct Scores {
  std::vector<FlightMoment> filter;
  std::vector<PhoneMoment> phone;
};

PoseMeasurement measurement_of(const PhonePoseReading& reading) {
  PoseMeasurement z{reading.position, reading.attitude, {}};
  z.covariance.setZero();
  z.covariance.diagonal() << reading.position_stddev.cwiseAbs2(),
      reading.attitude_stddev.cwiseAbs2();
  return z;
}

/// The filter over a sequence, with a phone that errs as `seed` says.
Scores run_filter(const Sequence& sequence, const DelayedUkf::Params& params, int seed) {
  DelayedUkf filter(params);
  PhonePoseSensor phone({}, RandomStream(static_cast<std::uint64_t>(seed), "phone"));
  const Time begin = std::max(sequence.truth.begin(), sequence.imu.front().time);
  Scores scores;
  for (const auto& [time, imu] : sequence.imu) {
    const auto truth = sequence.truth.at(time);
    if (!truth) continue;
    const double t = to_seconds(time - begin);
    if (filter.initialized()) (void)filter.predict(time, imu);
    VehicleTruth vehicle;
    vehicle.time = Time(time - begin);
    vehicle.body = *truth;
    if (const PhonePoseReading* reading = phone.update(vehicle)) {
      const PoseMeasurement z = measurement_of(*reading);
      if (filter.initialized()) {
        filter.update(time, z);
      } else {
        (void)filter.initialize(time, z);
      }
      scores.phone.push_back({t, *truth, z.p_WB, z.q_WB});
    }
    if (!filter.initialized()) continue;
    FlightMoment moment;
    moment.t = t;
    moment.truth = *truth;
    moment.estimate = filter.present().state();
    scores.filter.push_back(moment);
  }
  return scores;
}

void append_rows(const Sequence& sequence, const DelayedUkf::Params& params,
                 const ExperimentOptions& options, int& done, int total,
                 std::vector<ExperimentRow>& rows) {
  std::vector<ExperimentRow> phone(4), filter(4), ratio(4), velocity(3);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool position = i < 3;
    const std::string what = position ? fmt::format("position RMSE, {}", kAxes[i]) : "RMSE of Psi";
    const std::string unit = position ? "m" : "";
    phone[i].quantity = fmt::format("{}: phone's {}", sequence.name, what);
    filter[i].quantity = fmt::format("{}: UKF's {}", sequence.name, what);
    ratio[i].quantity = fmt::format("{}: {}, UKF to phone", sequence.name, what);
    phone[i].unit = filter[i].unit = unit;
    ratio[i].goal = 1.0;
    ratio[i].source = "the filter beats its measurements";
  }
  for (std::size_t i = 0; i < 3; ++i) {
    velocity[i].quantity = fmt::format("{}: UKF's velocity RMSE, {}", sequence.name, kAxes[i]);
    velocity[i].unit = "m/s";
    velocity[i].reference = velocity[i].goal = kFilterVelocity[static_cast<Eigen::Index>(i)];
    velocity[i].source = "seed 000, Table 3";
  }
  for (int seed = 1; seed <= options.seeds; ++seed) {
    options.progress(done++, total);
    const Scores scores = run_filter(sequence, params, seed);
    constexpr double kEver = std::numeric_limits<double>::infinity();
    Eigen::Vector4d of_phone, of_filter;
    of_phone << rmse(scores.phone, kSettle_s, kEver,
                     [](const PhoneMoment& m) { return Vector3d(m.p_WB - m.truth.p_WB); }),
        psi_rmse(scores.phone, kSettle_s, kEver,
                 [](const PhoneMoment& m) { return std::pair(m.q_WB, m.truth.q_WB); });
    of_filter << rmse(
        scores.filter, kSettle_s, kEver,
        [](const FlightMoment& m) { return Vector3d(m.estimate.p_WB - m.truth.p_WB); }),
        psi_rmse(scores.filter, kSettle_s, kEver,
                 [](const FlightMoment& m) { return std::pair(m.estimate.q_WB, m.truth.q_WB); });
    const Vector3d of_velocity = rmse(scores.filter, kSettle_s, kEver, [](const FlightMoment& m) {
      return Vector3d(m.estimate.v_WB_W - m.truth.v_WB_W);
    });
    for (int i = 0; i < 4; ++i) {
      const auto row = static_cast<std::size_t>(i);
      phone[row].values.push_back(of_phone[i]);
      filter[row].values.push_back(of_filter[i]);
      ratio[row].values.push_back(of_filter[i] / of_phone[i]);
      if (i < 3) velocity[row].values.push_back(of_velocity[i]);
    }
  }
  for (const auto* part : {&phone, &filter, &ratio, &velocity}) {
    rows.insert(rows.end(), part->begin(), part->end());
  }
}

}  // namespace

Result<ExperimentResult> run_euroc_filter(const ExperimentOptions& options) {
  const auto sequences = read_sequences(options.data);
  if (!sequences) return sequences.error();
  const Config parameters = Config::load(shared_file("experiments/euroc/parameters.yaml"));
  const DelayedUkf::Params params = read_estimator_params(parameters.child("estimator")).filter;
  ExperimentResult result{"euroc-filter", options.seeds, {}};
  int done = 0;
  const int total = options.seeds * static_cast<int>(sequences->size());
  for (const Sequence& sequence : *sequences) {
    append_rows(sequence, params, options, done, total, result.rows);
  }
  options.progress(total, total);
  return result;
}

}  // namespace swiftlet
