// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/runtime/reflection/type_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/runtime/message.hpp"

namespace swiftlet {
namespace {

using testing::HasSubstr;
using Kind = TypeDescription::Kind;

TEST(TypeLibrary, KnowsEveryMessageInEverySpelling) {
  const TypeLibrary& library = TypeLibrary::built_in();
  EXPECT_EQ(library.structs().size(), message_types().size());
  for (const MessageType* type : message_types()) {
    const TypeDescription* found = library.find(type->name());
    ASSERT_NE(found, nullptr) << type->name();
    EXPECT_EQ(found->name, type->name());
    EXPECT_EQ(library.find(type->dds_name()), found);
  }
  EXPECT_EQ(library.find("sensor_msgs::msg::Imu"), library.find("sensor_msgs/msg/Imu"));
  EXPECT_EQ(library.find("sensor_msgs/msg/Nose"), nullptr);
}

TypeLibrary parsed(const std::string& text) {
  auto library = TypeLibrary::parse({{"a.idl", text}});
  EXPECT_TRUE(library.ok()) << library.error().reason;
  return library.ok() ? std::move(library).value() : TypeLibrary();
}

TEST(TypeLibrary, ResolvesArraysBoundsAliasesAndConstants) {
  const TypeLibrary library = parsed(
      "module a { module msg {\n"
      "module Frame_Constants { const uint32 WIDTH = 4; };\n"
      "const long HEIGHT = Frame_Constants::WIDTH;\n"
      "typedef double Row[3];\n"
      "enum Colour { RED, GREEN };\n"
      "@final struct Frame {\n"
      "  @key uint8 data[Frame_Constants::WIDTH][HEIGHT][2];\n"
      "  string<8> name; sequence<long long, 5> numbers; Row rows[2]; Colour colour;\n"
      "  unsigned short a, b[2];\n"
      "}; }; };");
  const TypeDescription* frame = library.find("a/msg/Frame");
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->member("data")->name, "uint8[4][4][2]");
  EXPECT_EQ(frame->member("data")->count, 4u);
  EXPECT_EQ(frame->member("data")->element->name, "uint8[4][2]");
  EXPECT_EQ(frame->member("data")->minimum_size, 32u);
  EXPECT_EQ(frame->member("name")->count, 8u);
  EXPECT_EQ(frame->member("numbers")->name, "sequence<long long, 5>");
  EXPECT_EQ(frame->member("numbers")->element->primitive, Primitive::kInt64);
  EXPECT_EQ(frame->member("rows")->minimum_size, 48u);
  EXPECT_EQ(frame->member("colour")->primitive, Primitive::kUint32);
  EXPECT_EQ(frame->member("b")->element->primitive, Primitive::kUint16);
  EXPECT_EQ(frame->minimum_size, 32u + 4 + 4 + 48 + 4 + 2 + 4);
}

TEST(TypeLibrary, ANameIsLookedUpFromTheInnermostScopeOutwards) {
  const TypeLibrary library = parsed(
      "module b { struct X { double outer; }; module msg {\n"
      "struct User { X x; ::b::X y; c::X z; }; struct X { octet inner; }; }; };\n"
      "module c { struct X { long x; }; };");
  const TypeDescription* user = library.find("b/msg/User");
  EXPECT_EQ(user->member("x")->name, "b/msg/X");
  EXPECT_EQ(user->member("y")->name, "b/X");
  EXPECT_EQ(user->member("z")->name, "c/X");
}

TEST(TypeLibrary, RefusesWhatHasNoMeaningAndNamesTheLine) {
  const auto reason = [](const std::string& text) {
    const auto library = TypeLibrary::parse({{"a.idl", text}});
    return library.ok() ? std::string("accepted") : library.error().reason;
  };
  EXPECT_THAT(reason("module a {\nstruct A { Missing m; };\n};"),
              AllOf(HasSubstr("a.idl:2"), HasSubstr("'Missing'")));
  EXPECT_THAT(reason("struct A { A a; };"), HasSubstr("A contains itself"));
  EXPECT_THAT(reason("struct A { B b[2]; }; struct B { A a; };"), HasSubstr("contains itself"));
  EXPECT_THAT(reason("struct A { A2 a; }; typedef A2 A2;"), HasSubstr("leads to itself"));
  EXPECT_THAT(reason("struct A { octet a[N]; };"), HasSubstr("'N'"));
  EXPECT_THAT(reason("const long N = N; struct A { octet a[N]; };"), HasSubstr("'N'"));
  EXPECT_THAT(reason("struct A { octet a[0]; };"), HasSubstr("no size"));
  EXPECT_THAT(reason("struct A { octet a[99999999999999999999]; };"), HasSubstr("no size"));
  EXPECT_THAT(reason("struct A { double a[1000000][1000000]; };"), HasSubstr("1 GiB"));
  EXPECT_THAT(reason("struct A { octet a; };\nstruct A { octet b; };"),
              AllOf(HasSubstr("a.idl:2"), HasSubstr("twice")));
}

}  // namespace
}  // namespace swiftlet
