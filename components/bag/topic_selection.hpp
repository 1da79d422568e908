// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <regex>
#include <string>
#include <vector>

namespace swiftlet {

/// Which topics are wanted, as people write it. Names are those in a file: without vehicle; a
/// leading '/' does not matter.
struct TopicPatterns {
  /// Names, or patterns: '*' stands for anything within a part between '/', '**' for anything, '?'
  /// for one character.
  std::vector<std::string> topics{};
  std::vector<std::string> regexes{};  ///< ECMAScript; the whole name must match
  std::vector<std::string> exclude{};  ///< names or patterns; wins over the others
};

/// The same, ready for use. Without topics and regexes, all that is not excluded is wanted.
class TopicSelection {
 public:
  /// Throws ConfigError where no topic can have such a name, or a regular expression is none.
  explicit TopicSelection(const TopicPatterns& patterns);

  bool wants(const std::string& topic) const;
  /// What was asked for, as it was written, and fits none of `topics`.
  std::vector<std::string> missing(const std::vector<std::string>& topics) const;

 private:
  struct Pattern {
    std::string text;
    std::regex regex;
  };
  static Pattern glob(const std::string& text);

  std::vector<Pattern> wanted_;
  std::vector<Pattern> excluded_;
};

/// Names in rosbag2's files begin with a slash, ours do not.
std::string without_slash(const std::string& topic);

}  // namespace swiftlet
