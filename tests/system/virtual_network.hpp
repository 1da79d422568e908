// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Several hosts on one machine: network namespaces and bridges that end with the test.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/system/recorded.hpp"
#include "tests/system/system_test.hpp"

namespace swiftlet::test {

/// Makes hosts and connects them. Skips the test, with the reason, where that cannot be done.
class NetworkTest : public SystemTest {
 protected:
  /// A host with nothing but its loopback interface.
  void add_host(const std::string& host);
  /// Gives `host` the interface with that address ("10.9.0.1/24"), plugged into `bridge`. The
  /// interface is up.
  void connect(const std::string& host, const std::string& interface, const std::string& address,
               const std::string& bridge);
  /// Hosts "vehicle" 10.9.0.1, "companion" 10.9.0.2 and "ground" 10.9.0.3 on one wire, as eth0.
  void make_three_hosts();

  /// Starts `swiftlet <arguments>` on a host.
  Process start_on(const std::string& host, const Arguments& arguments);
  /// Starts any command on a host.
  Process start_command_on(const std::string& host, const Arguments& command);
  Finished run_on(const std::string& host, const Arguments& arguments, Seconds limit = kExitLimit);
  /// Runs a line of shell on a host ("" is the switch between them); a failure of the test where it
  /// does not end with 0.
  std::string shell_on(const std::string& host, const std::string& line);

  /// Drops `percent` of all that the host receives on its interfaces.
  void lose_on(const std::string& host, int percent);
  /// Plugs and unplugs the far end of an interface.
  void set_link(const std::string& host, const std::string& interface, bool up);
  /// "tx_bytes", "rx_packets", ... of an interface.
  std::int64_t counter(const std::string& host, const std::string& interface,
                       const std::string& name);
  /// A process in the host's namespace.
  pid_t id_of(const std::string& host) const;

 private:
  std::string port_of(const std::string& host, const std::string& interface) const;
  Process make_namespace();

  std::vector<Process> holders_;
  std::map<std::string, std::size_t> hosts_;  // index of the holder; "" is the switch
  std::map<std::string, int> ports_;          // by "host.interface"
};

/// A vehicle that is spread over hosts, and somebody who flies it from one of them.
class SpreadVehicleTest : public NetworkTest {
 protected:
  void SetUp() override;

  /// Starts `swiftlet launch FILE --host HOST` on each of them.
  void launch(const std::string& file, const std::vector<std::string>& hosts);
  /// Arms, flies to each place in turn, and lands, by `gcs` on `station` with `network` added.
  void fly(const std::vector<std::array<double, 2>>& places, double altitude);
  void take_off(double altitude);
  void go_to(double x, double y);
  void land();
  /// Nothing was touched, by the record of the simulator's truth.
  void expect_no_contact();
  void record_truth(const Arguments& network);

  /// Until accepted, as a person would who sees "not acknowledged".
  void command(const Arguments& arguments);
  nlohmann::json status();
  template <class Condition>
  void status_becomes(const std::string& what, Seconds limit, Condition condition) {
    nlohmann::json last;
    ASSERT_TRUE(becomes_true(limit,
                             [&] {
                               const nlohmann::json now = status();
                               if (now.is_null()) return false;
                               last = now;
                               return condition(now);
                             }))
        << "never " << what << ": " << last.dump(2) << diagnosis() << logs();
  }
  std::string logs() const;
  /// What the doctor says, as the station sees it.
  std::string diagnosis();

  std::string station_ = "ground";
  Arguments network_;  // of gcs on the station
  std::map<std::string, Process> launched_;
  std::optional<Process> recorder_;
};

}  // namespace swiftlet::test
