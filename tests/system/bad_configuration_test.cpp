// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// Scenarios, worlds and parameters that cannot be used.
#include <fstream>
#include <iterator>
#include <random>

#include "tests/system/bad_input.hpp"

namespace swiftlet::test {
namespace {

using Arguments = std::vector<std::string>;

/// What a scenario needs; what a test adds is on line 6.
const std::string kScenario = R"(name: bad
world: room.sdf
start: {x: 1.0, y: 1.0}
mission: {waypoints: [{x: 2.0, y: 2.0}]}
time_limit_s: 30
)";

const Arguments kFly{"fly",          "{in}/bad.yaml", "--record",
                     "{out}/f.mcap", "--report",      "{out}/report"};
const Arguments kRunSim{"run", "sim", "--scenario", "{in}/bad.yaml"};

std::string room() {
  std::ifstream stream(hop_world(), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The text with the first `what` replaced. Throws where it is not there.
std::string with(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

BadInput scenario(const std::string& name, const std::string& content,
                  const std::vector<std::string>& says) {
  return {name, kFly, says, {{"bad.yaml", content}, {"room.sdf", room()}}};
}

BadInput line_6(const std::string& name, const std::string& line,
                const std::vector<std::string>& says) {
  BadInput input = scenario(name, kScenario + line + "\n", says);
  input.says.push_back("{in}/bad.yaml:6: ");
  return input;
}

BadInput world(const std::string& name, const std::string& sdf,
               const std::vector<std::string>& says) {
  return {name, kFly, says, {{"bad.yaml", kScenario}, {"room.sdf", sdf}}};
}

BadInput parameters(const std::string& name, const std::string& yaml,
                    const std::vector<std::string>& says) {
  return {name,
          {"fly", hop(), "--record", "{out}/f.mcap", "--report", "{out}/report", "--params",
           "{in}/params.yaml"},
          says,
          {{"params.yaml", yaml}}};
}

BadInput parameter(const std::string& name, const std::string& value,
                   const std::vector<std::string>& says) {
  return {name,
          {"fly", hop(), "--record", "{out}/f.mcap", "--report", "{out}/report", "--param", value},
          says};
}

/// The same mistake, made with `run`: it must not start to serve.
BadInput hosted(BadInput input) {
  input.name += "Hosted";
  const bool is_scenario = input.arguments == kFly;
  input.arguments =
      is_scenario ? kRunSim : Arguments{"run", "planner", "--params", "{in}/params.yaml"};
  return input;
}

std::string noise(std::size_t size) {
  std::mt19937 random(5);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

class BadConfiguration : public BadInputTest, public testing::WithParamInterface<BadInput> {};
TEST_P(BadConfiguration, IsRefused) {
  expect_refused(GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    Scenario, BadConfiguration,
    testing::Values(
        BadInput{"Missing", kFly, {"{in}/bad.yaml: ", "cannot be read", "check the path"}},
        BadInput{"Folder",
                 {"fly", "{in}", "--record", "{out}/f.mcap"},
                 {"{in}: ", "cannot be read", "check the path"}},
        scenario("Empty", "", {"{in}/bad.yaml:1: ", "'name' is missing; add it"}),
        scenario("Malformed", kScenario + "wind: [1, 2\n", {"{in}/bad.yaml:7: ", "not valid YAML"}),
        scenario("Noise", noise(3000), {"{in}/bad.yaml:", "not valid YAML"}),
        scenario("List", "- name: bad\n", {"{in}/bad.yaml:1: ", "expected a mapping"}),
        line_6("NumberThatIsText", "seed: many", {"'seed' must be a number, not 'many'"}),
        line_6("MappingThatIsNumber", "wind: 3", {"'wind' must be a mapping"}),
        line_6("ListThatIsMapping", "obstacles: {name: door}", {"'obstacles' must be a list"}),
        line_6("TooFewNumbers", "wind: {mean: [1, 2]}", {"'mean' must have 3 numbers, not 2"}),
        line_6("NotANumber", "vehicle: {mass: .nan}", {"'mass' must be a finite number"}),
        line_6("NotANumberInAList", "wind: {mean: [.nan, 0, 0]}", {"'mean'", "finite"}),
        line_6("Infinite", "map: {max: [.inf, 1]}", {"'max'", "finite"}),
        line_6("OutOfRange", "sensors: {lidar: {beams: 0}}", {"'beams' must be from 1"}),
        line_6("CannotFly", "vehicle: {mass: 50}", {"does not lift", "raise it or lower"}),
        line_6("UnknownKey", "sede: 3", {"unknown key 'sede'", "did you mean 'seed'?"}),
        line_6("UnknownKeyInside", "sensors: {lidarr: {}}", {"did you mean 'lidar'?"}),
        // Which of the two is meant? YAML forbids it.
        line_6("KeyGivenTwice", "time_limit_s: 40", {"'time_limit_s'", "twice"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    World, BadConfiguration,
    testing::Values(scenario("Missing", with(kScenario, "room.sdf", "none.sdf"),
                             {"{in}/bad.yaml:2: ", "none.sdf' is not there", "relative to"}),
                    world("Empty", "", {"{in}/room.sdf: ", "not a usable SDFormat world"}),
                    world("Malformed", room().substr(0, 800),
                          {"{in}/room.sdf:", "not a usable SDFormat world"}),
                    world("Noise", noise(3000), {"{in}/room.sdf:", "not a usable SDFormat world"}),
                    world("WithoutAWorld", "<sdf version=\"1.9\"></sdf>",
                          {"{in}/room.sdf: ", "no <world> in it", "put the models into"}),
                    world("SizeThatIsText", with(room(), "4.2 0.1 2.5", "wide 0.1 2.5"),
                          {"{in}/room.sdf:20: ", "[wide 0.1 2.5"}),
                    world("SizeThatIsNotANumber", with(room(), "4.2 0.1 2.5", "nan 0.1 2.5"),
                          {"{in}/room.sdf:20: ", "nan"}),
                    world("NegativeSize", with(room(), "4.2 0.1 2.5", "-4.2 0.1 2.5"),
                          {"{in}/room.sdf:", "'walls'", "'south'", "give a positive length"}),
                    world("PoseThatIsNotANumber", with(room(), "2 -0.05 1.25", "nan -0.05 1.25"),
                          {"{in}/room.sdf:19: ", "finite"}),
                    world("SizeMissing", with(room(), "<size>4.2 0.1 2.5</size>", ""),
                          {"{in}/room.sdf:", "<box> has no <size>; add it"}),
                    world("MeshMissing",
                          with(room(), "<box><size>4.2 0.1 2.5</size></box>",
                               "<mesh><uri>none.stl</uri></mesh>"),
                          {"{in}/room.sdf:20: ", "'none.stl' is not there", "relative to"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Parameters, BadConfiguration,
    testing::Values(
        BadInput{"Missing",
                 {"fly", hop(), "--record", "{out}/f.mcap", "--params", "{in}/params.yaml"},
                 {"{in}/params.yaml: ", "cannot be read", "check the path"}},
        parameters("Malformed", "planner: {max_speed: 1\n",
                   {"{in}/params.yaml:2: ", "not valid YAML"}),
        parameters("List", "- planner\n", {"{in}/params.yaml:1: ", "expected a mapping"}),
        parameters("NumberThatIsText", "planner:\n  max_speed: fast\n",
                   {"{in}/params.yaml:2: ", "'max_speed' must be a number, not 'fast'"}),
        parameters("SectionThatIsNumber", "planner: 3\n",
                   {"{in}/params.yaml:1: ", "'planner' must be a mapping"}),
        parameters("NotANumber", "planner:\n  max_speed: .nan\n",
                   {"{in}/params.yaml:2: ", "'max_speed' must be a finite number"}),
        parameters("OutOfRange", "planner:\n  max_speed: -1\n",
                   {"{in}/params.yaml:2: ", "'max_speed' must be positive"}),
        parameters("UnknownKey", "planner:\n  max_sped: 1\n",
                   {"{in}/params.yaml:2: ", "did you mean 'max_speed'?"}),
        parameters("UnknownComponent", "planner: {}\nestimatr: {}\n",
                   {"{in}/params.yaml:2: ", "did you mean 'estimator'?"}),
        parameter("OneWithoutEquals", "planner.max_speed", {"--param", "component.key=value"}),
        parameter("OneWithoutDot", "max_speed=1", {"--param", "component.key=value"}),
        parameter("OneWithoutName", "=1", {"--param", "component.key=value"}),
        parameter("OneWithoutKey", "planner.=1", {"planner.=1: ", "unknown key"}),
        parameter("OneWithoutValue", "planner.max_speed=", {"planner.max_speed", "number"}),
        parameter("OneMalformed", "planner.max_speed=[", {"planner.max_speed=[", "not valid YAML"}),
        parameter("OneThatIsText", "planner.max_speed=fast", {"'max_speed' must be a number"}),
        parameter("OneThatIsNotANumber", "planner.max_speed=.nan",
                  {"'max_speed' must be a finite number"}),
        parameter("OneUnknownKey", "planner.max_sped=1",
                  {"planner.max_sped=1: ", "did you mean 'max_speed'?"}),
        parameter("OneUnknownComponent", "plannr.max_speed=1",
                  {"plannr.max_speed=1: ", "did you mean 'planner'?"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Hosted, BadConfiguration,
    testing::Values(
        hosted(BadInput{"ScenarioMissing", kFly, {"{in}/bad.yaml: ", "cannot be read"}}),
        hosted(line_6("Scenario", "sede: 3", {"did you mean 'seed'?"})),
        hosted(world("World", room().substr(0, 800), {"{in}/room.sdf:", "not a usable"})),
        hosted(parameters("Parameters", "planner:\n  max_sped: 1\n",
                          {"{in}/params.yaml:2: ", "did you mean 'max_speed'?"})),
        BadInput{"ScenarioNotGiven", {"run", "sim"}, {"'sim'", "--scenario"}}),
    name_of);

}  // namespace
}  // namespace swiftlet::test
