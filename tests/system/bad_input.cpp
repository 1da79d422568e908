// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/system/bad_input.hpp"

#include <algorithm>

namespace swiftlet::test {
namespace {

constexpr std::size_t kLongestMessage = 1000;  // what a person reads

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size();
  }
  return text;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const BadInput& input) {
  out << "swiftlet";
  for (const std::string& argument : input.arguments) out << " '" << argument << "'";
  return out;
}

std::string name_of(const testing::TestParamInfo<BadInput>& info) {
  return info.param.name;
}

BadInputTest::BadInputTest() {
  std::filesystem::create_directories(folder() / "in");
  std::filesystem::create_directories(folder() / "out");
}

SystemTest::Arguments BadInputTest::expand(const Arguments& arguments) const {
  Arguments expanded = arguments;
  for (std::string& argument : expanded) {
    argument = replaced(argument, "{in}", path("in"));
    argument = replaced(argument, "{out}", path("out"));
  }
  return expanded;
}

std::vector<std::string> BadInputTest::left_behind() const {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder() / "out")) {
    files.push_back(entry.path().lexically_relative(folder()).string());
  }
  return files;
}

void BadInputTest::expect_refused(const BadInput& input) {
  for (const auto& [name, text] : input.files) write("in/" + name, text);
  for (const auto& [name, value] : input.environment) environment_[name] = value;
  // What is accepted by mistake may run for ever; it does not get the time.
  Process process = start(expand(input.arguments));
  const auto finished = process.wait(kExitLimit);
  EXPECT_THAT(left_behind(), testing::IsEmpty());
  ASSERT_TRUE(finished) << "was not refused; it wrote: " << process.out() << process.err();
  EXPECT_EQ(finished->exit_code, 2);
  EXPECT_THAT(finished->err, testing::Not(testing::HasSubstr("unexpected error")));
  EXPECT_LE(finished->err.size(), kLongestMessage);
  for (const std::string& words : input.says) {
    EXPECT_THAT(finished->err, testing::HasSubstr(replaced(words, "{in}", path("in"))));
  }
}

}  // namespace swiftlet::test
