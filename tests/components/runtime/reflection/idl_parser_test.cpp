// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/idl_parser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "components/runtime/reflection/idl_lexer.hpp"

namespace swiftlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(IdlLexer, CommentsAndPreprocessorLinesBecomeBlanksAndPositionsStay) {
  const std::string text =
      "#include \"x.idl\"\na // b \" c\n\"// not this\" /* d\ne */ f//\n  #if 1\n/**/g/h";
  const std::string clean = without_comments(text);
  EXPECT_EQ(clean.size(), text.size());
  EXPECT_EQ(std::count(clean.begin(), clean.end(), '\n'), 5);
  std::vector<std::string> words;
  for (const IdlToken& token : idl_tokens(clean)) words.push_back(token.text);
  EXPECT_THAT(words, testing::ElementsAre("a", "\"// not this\"", "f", "g", "/", "h", ""));
  EXPECT_EQ(without_comments("a /* never closed").find_first_not_of("a "), std::string::npos);
}

TEST(IdlParser, GivesDefinitionsWithScopeTextAndLine) {
  const auto parsed = parse_idl(
      {"a.idl",
       "module a {\nmodule msg {\n/* no */ struct Thing { // of the Other\n  uint8 colour; };\n"
       "const double X = -1.5e-3;\n}; };"});
  ASSERT_TRUE(parsed.ok()) << parsed.error().reason;
  ASSERT_EQ(parsed->size(), 4u);
  const IdlDefinition& thing = (*parsed)[2];
  EXPECT_EQ(thing.full_name(), "a::msg::Thing");
  EXPECT_EQ(thing.where, "a.idl:3");
  EXPECT_THAT(thing.text, AllOf(testing::StartsWith("struct Thing {"), testing::EndsWith("};"),
                                testing::Not(HasSubstr("Other"))));
  EXPECT_EQ((*parsed)[3].value, "-1.5e-3");
}

TEST(IdlParser, SaysWhatIsWrongAndWhere) {
  const auto reason = [](const std::string& text) {
    const auto parsed = parse_idl({"a.idl", text});
    return parsed.ok() ? std::string("accepted") : parsed.error().reason;
  };
  EXPECT_THAT(reason("module a {\n\nunion U {}; };"),
              AllOf(HasSubstr("a.idl:3"), HasSubstr("before 'union'")));
  EXPECT_THAT(reason("struct A { long x; "), HasSubstr("the end of the file"));
  EXPECT_THAT(reason("struct A { };"), HasSubstr("a member of A"));
  EXPECT_THAT(reason("struct A : B { long x; };"), HasSubstr("without a base"));
  EXPECT_THAT(reason("struct A { map<long, long> x; };"), HasSubstr("no map"));
  EXPECT_THAT(reason("struct A { wstring x; };"), HasSubstr("no wstring"));
  EXPECT_THAT(reason("struct A { long double x; };"), HasSubstr("long double"));
  EXPECT_THAT(reason("struct A { long x[2 + 3]; };"), HasSubstr("']' expected"));
  EXPECT_THAT(reason("struct A { long x[]; };"), HasSubstr("a value expected"));
  EXPECT_THAT(reason("@a(( struct A { long x; };"), HasSubstr("')' expected"));
  EXPECT_THAT(reason("struct A { long 3x; };"), HasSubstr("a name expected"));
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "sequence<";
  EXPECT_THAT(reason("struct A { " + deep), HasSubstr("fewer sequences"));
}

TEST(IdlParser, AnyTextIsSurvived) {
  const std::vector<std::string> words{"module", "struct", "a",  "b", "{",        "}",  ";",
                                       "[",      "]",      "<",  ">", "sequence", "::", "const",
                                       "=",      "3",      "/*", "*", "/",        "\"", "typedef",
                                       "@",      "(",      ")",  ",", "double",   "#",  "\n"};
  std::mt19937 random(11);
  for (int i = 0; i < 20'000; ++i) {
    std::string text = i % 2 == 0 ? "" : "struct S {";
    for (auto length = random() % 20; length > 0; --length) {
      text += words[random() % words.size()] + (random() % 2 == 0 ? " " : "");
    }
    const auto parsed = parse_idl({"a.idl", text});
    if (!parsed.ok()) {
      EXPECT_THAT(parsed.error().reason, HasSubstr("a.idl:"));
    }
  }
}

}  // namespace
}  // namespace swiftlet
