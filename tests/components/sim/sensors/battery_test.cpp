// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/sensors/battery.hpp"

#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

VehicleTruth at(double seconds, double thrust) {
  VehicleTruth truth;
  truth.time = Time(from_seconds(seconds));
  truth.rotor_thrusts.setConstant(thrust);
  return truth;
}

Battery::Params noiseless() {
  Battery::Params params;
  params.voltage_noise = params.current_noise = 0.0;
  return params;
}

TEST(Battery, AFullPackOfFourCellsHasTheVoltageOfThePaper) {
  EXPECT_NEAR(4.0 * Battery::cell_voltage(1.0), 16.8, 1e-9);
  EXPECT_NEAR(4.0 * Battery::cell_voltage(0.3), 14.8, 0.4);  // nominal, in the flat part
  for (double s = 0.0; s < 1.0; s += 0.01) {
    EXPECT_LE(Battery::cell_voltage(s), Battery::cell_voltage(s + 0.01));
  }
}

TEST(Battery, TerminalsGiveThePowerThatIsDrawn) {
  Battery::Params params = noiseless();
  Battery battery(params, RandomStream(1, "battery"));
  const BatteryReading* reading = battery.update(at(0.04, 3.0));
  ASSERT_NE(reading, nullptr);
  const double disc = M_PI * params.propeller_radius * params.propeller_radius;
  const double induced = std::pow(3.0, 1.5) / std::sqrt(2.0 * 1.225 * disc);
  const double power = params.electronics_power + 4.0 * induced / params.efficiency;
  EXPECT_NEAR(reading->voltage * reading->current, power, 1e-6);
  EXPECT_NEAR(reading->voltage, 16.8 - params.internal_resistance * reading->current, 1e-3);
}

TEST(Battery, ChargeThatIsGoneIsTheIntegralOfTheCurrent) {
  Battery battery(noiseless(), RandomStream(1, "battery"));
  double ampere_hours = 0.0;
  double charge = 0.0;
  for (int i = 1; i <= 25 * 120; ++i) {
    const BatteryReading* reading = battery.update(at(0.04 * i, 2.2));
    ASSERT_NE(reading, nullptr);
    ampere_hours += reading->current * 0.04 / 3600.0;
    charge = reading->charge;
  }
  EXPECT_NEAR(4.0 - charge, ampere_hours, 1e-6);
  EXPECT_GT(ampere_hours, 0.05);
}

TEST(Battery, TheVehicleOfThePaperFliesAboutTenMinutes) {
  // 2.05 kg on four propellers of 9.5 inch, 4S 4,000 mAh: "around 10 minutes" (seed 004).
  Battery battery(noiseless(), RandomStream(1, "battery"));
  const double thrust = 2.05 * kGravity / 4.0;
  double seconds = 0.0;
  while (battery.state_of_charge() > 0.1 && seconds < 3600.0) {
    seconds += 0.5;
    battery.update(at(seconds, thrust));
  }
  EXPECT_GT(seconds / 60.0, 8.0);
  EXPECT_LT(seconds / 60.0, 13.0);
}

TEST(Battery, NeverGivesANumberThatIsNone) {
  Battery::Params params = noiseless();
  params.internal_resistance = 2.0;  // cannot give what the rotors want
  params.charge_at_start = 0.01;
  Battery battery(params, RandomStream(1, "battery"));
  for (int i = 1; i < 2000; ++i) {
    const BatteryReading* reading = battery.update(at(i, 20.0));
    ASSERT_TRUE(std::isfinite(reading->voltage) && std::isfinite(reading->current));
    ASSERT_GE(reading->percentage, 0.0);
  }
  EXPECT_EQ(battery.state_of_charge(), 0.0);
}

}  // namespace
}  // namespace swiftlet
