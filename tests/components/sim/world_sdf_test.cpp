// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/world.hpp"
#include "tests/components/sim/fixture.hpp"

namespace swiftlet {
namespace {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

std::string sdf(const std::string& models) {
  return "<sdf version=\"1.9\">\n<world name=\"w\">\n" + models + "\n</world>\n</sdf>\n";
}

/// A world with one collision; its <geometry> is on line 5.
std::string with_geometry(const std::string& geometry) {
  return sdf(
      "<model name=\"thing\"><static>true</static><link name=\"link\">\n"
      "<collision name=\"part\">\n<geometry>" +
      geometry +
      "</geometry>\n"
      "</collision></link></model>");
}

class WorldSdf : public testing::Test {
 protected:
  World load(const std::string& content) { return World::load(folder.write("w.sdf", content)); }
  std::string error_of(const std::string& content) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    const std::string message = test::config_error([&] { load(content); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    return message;
  }
  test::TemporaryFolder folder;
};

TEST_F(WorldSdf, ComposesThePosesOfModelLinkAndCollision) {
  const World world = load(sdf(R"(
    <model name="m"><static>true</static><pose>1 2 0 0 0 1.5707963267948966</pose>
      <link name="l"><pose>1 0 0.5 0 0 0</pose>
        <collision name="c"><pose>0 1 0 0 0 0.3</pose>
          <geometry><sphere><radius>0.25</radius></sphere></geometry></collision></link></model>)"));
  // Turned by 90 degrees: x of the model is y of the world, y of the model is -x.
  const auto nearest = world.nearest({0, 3, 2}, 10.0);
  ASSERT_TRUE(nearest.has_value());
  EXPECT_EQ(nearest->model, "m");
  EXPECT_NEAR(nearest->distance, 1.5 - 0.25, 1e-9);
}

TEST_F(WorldSdf, ResolvesRelativeToAndNestedModels) {
  const World world = load(sdf(R"(
    <model name="a"><static>true</static><pose>5 0 0 0 0 0</pose>
      <frame name="shelf"><pose>0 0 2 0 0 0</pose></frame>
      <link name="l"><collision name="c"><pose relative_to="shelf">0 1 0 0 0 0</pose>
        <geometry><sphere><radius>0.5</radius></sphere></geometry></collision></link>
      <model name="inner"><pose>0 0 -3 0 0 0</pose><link name="l"><collision name="c">
        <geometry><sphere><radius>0.5</radius></sphere></geometry></collision></link></model>
    </model>
    <model name="b"><static>true</static><pose relative_to="a">0 -4 0 0 0 0</pose>
      <link name="l"><collision name="c">
        <geometry><sphere><radius>0.5</radius></sphere></geometry></collision></link></model>)"));
  EXPECT_NEAR(world.nearest({5, 1, 3}, 9.0)->distance, 0.5, 1e-9);
  EXPECT_NEAR(world.nearest({5, -4, 1}, 9.0)->distance, 0.5, 1e-9);
  EXPECT_EQ(world.nearest({5, -4, 1}, 9.0)->model, "b");
  EXPECT_EQ(world.nearest({5, 0, -4}, 9.0)->model, "a::inner");
}

TEST_F(WorldSdf, ReadsEveryGeometry) {
  folder.write("meshes/ramp.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string shapes = R"(
    <model name="all"><static>true</static><link name="l">
      <collision name="1"><geometry><plane><normal>0 0 1</normal></plane></geometry></collision>
      <collision name="2"><pose>10 0 5 0 0 0</pose>
        <geometry><box><size>2 4 6</size></box></geometry></collision>
      <collision name="3"><pose>20 0 5 0 0 0</pose>
        <geometry><cylinder><radius>1</radius><length>4</length></cylinder></geometry></collision>
      <collision name="4"><pose>30 0 5 0 0 0</pose><geometry><mesh>
        <uri>meshes/ramp.obj</uri><scale>2 3 1</scale></mesh></geometry></collision>
    </link></model>)";
  const World world = load(sdf(shapes));
  ASSERT_EQ(world.shapes().size(), 4U);
  const auto height = [&](double x, double y) {
    return 50.0 - world.cast_ray({x, y, 50.0}, -Vector3d::UnitZ(), 100.0)->range;
  };
  EXPECT_NEAR(height(-5, 0), 0.0, 1e-5);
  EXPECT_NEAR(height(10.9, 1.9), 8.0, 1e-5);
  EXPECT_NEAR(height(11.1, 1.9), 0.0, 1e-5);
  EXPECT_NEAR(height(20.6, 0.6), 7.0, 1e-5);
  EXPECT_NEAR(height(20.8, 0.8), 0.0, 1e-5);
  EXPECT_NEAR(height(31.9, 0.1), 5.0, 1e-5);  // the scaled triangle reaches x = 32, y = 3
  EXPECT_NEAR(height(30.1, 2.7), 5.0, 1e-5);
  EXPECT_NEAR(height(31.1, 1.6), 0.0, 1e-5);
  EXPECT_TRUE(world.shapes()[0]->is_ground);
  EXPECT_FALSE(world.shapes()[1]->is_ground);
}

TEST_F(WorldSdf, IncludesModelsBesideTheWorld) {
  folder.write("models/ball/model.config",
               "<model><name>ball</name><sdf version=\"1.9\">model.sdf</sdf></model>");
  folder.write("models/ball/model.sdf",
               "<sdf version=\"1.9\"><model name=\"ball\"><static>true</static><link name=\"l\">"
               "<collision name=\"c\"><geometry><sphere><radius>1</radius></sphere></geometry>"
               "</collision></link></model></sdf>");
  const World world = load(
      sdf("<include><uri>model://ball</uri><name>globe</name><pose>4 0 0 0 0 0</pose></include>"));
  EXPECT_EQ(world.nearest({0, 0, 0}, 10.0)->model, "globe");
  EXPECT_NEAR(world.nearest({0, 0, 0}, 10.0)->distance, 3.0, 1e-9);
}

TEST_F(WorldSdf, ModelsNamedAsGroundMayBeLandedOn) {
  const auto file = folder.write("w.sdf", with_geometry("<box><size>1 1 0.1</size></box>"));
  EXPECT_FALSE(World::load(file).ground_height(0, 0).has_value());
  EXPECT_NEAR(World::load(file, {"thing"}).ground_height(0, 0).value(), 0.05, 1e-9);
}

TEST_F(WorldSdf, AMissingFileIsNamed) {
  const std::string message = test::config_error([&] { World::load("/nowhere/office.sdf"); });
  EXPECT_THAT(message, AllOf(HasSubstr("/nowhere/office.sdf"), HasSubstr("check the path")));
  EXPECT_NE(test::config_error([&] { World::load(folder.path()); }), "");
}

TEST_F(WorldSdf, MalformedFilesAreRefusedWithTheirName) {
  for (const char* content : {"", "hello", "<sdf version=\"1.9\"><world name=\"w\">", "<gazebo/>",
                              "<sdf><world name=\"w\"/></sdf>"}) {
    EXPECT_THAT(error_of(content), HasSubstr("w.sdf")) << content;
  }
}

TEST_F(WorldSdf, BrokenXmlIsFoundInItsLine) {
  EXPECT_THAT(error_of("<sdf version=\"1.9\">\n<world name=\"w\">\n</wrold>\n</sdf>"),
              AllOf(HasSubstr("w.sdf:2: not a usable SDFormat world"), HasSubstr("MISMATCHED")));
}

TEST_F(WorldSdf, AFileWithoutAWorldSaysWhatToDo) {
  EXPECT_THAT(error_of("<sdf version=\"1.9\"><model name=\"m\"><link name=\"l\"/></model></sdf>"),
              AllOf(HasSubstr("w.sdf"), HasSubstr("no <world>"), HasSubstr("<sdf><world")));
}

TEST_F(WorldSdf, UnsupportedGeometryIsNamedWithItsPlace) {
  EXPECT_THAT(
      error_of(with_geometry("<capsule><radius>1</radius><length>1</length></capsule>")),
      AllOf(HasSubstr("w.sdf:5"), HasSubstr("model 'thing' / link 'link' / collision 'part'"),
            HasSubstr("not supported"), HasSubstr("plane, box, cylinder")));
  EXPECT_THAT(error_of(with_geometry("")), HasSubstr("w.sdf"));
}

TEST_F(WorldSdf, SizesThatAreNoSizesAreRefusedWithTheirPlace) {
  for (const char* geometry :
       {"<box><size>1 -1 1</size></box>", "<box><size>1 0 1</size></box>",
        "<box><size>1 nan 1</size></box>", "<box><size>1 inf 1</size></box>",
        "<box><size>one</size></box>", "<sphere><radius>-0.5</radius></sphere>",
        "<sphere><radius>nan</radius></sphere>",
        "<cylinder><radius>1</radius><length>-2</length></cylinder>",
        "<plane><normal>0 0 0</normal></plane>"}) {
    const std::string message = error_of(with_geometry(geometry));
    EXPECT_THAT(message, HasSubstr("w.sdf:")) << geometry;
    EXPECT_FALSE(message.empty()) << geometry;
  }
  EXPECT_THAT(error_of(with_geometry("<box><size>1 nan 1</size></box>")),
              AllOf(HasSubstr("w.sdf:5"), HasSubstr("<size>"), HasSubstr("1 nan 1")));
  EXPECT_THAT(error_of(with_geometry("<box><size>1 -1 1</size></box>")),
              AllOf(HasSubstr("collision 'part'"), HasSubstr("-1 m"), HasSubstr("positive")));
}

TEST_F(WorldSdf, AMisspeltDimensionIsNotReplacedByADefault) {
  EXPECT_THAT(error_of(with_geometry("<sphere><raduis>0.2</raduis></sphere>")),
              AllOf(HasSubstr("w.sdf:5"), HasSubstr("no <radius>"), HasSubstr("add it")));
  EXPECT_THAT(error_of(with_geometry("<box/>")), HasSubstr("no <size>"));
}

TEST_F(WorldSdf, PosesThatAreNotFiniteAreRefused) {
  const std::string message = error_of(
      sdf("<model name=\"m\"><static>true</static><pose>nan 0 0 0 0 0</pose><link name=\"l\">"
          "<collision name=\"c\"><geometry><sphere><radius>1</radius></sphere></geometry>"
          "</collision></link></model>"));
  EXPECT_THAT(message, HasSubstr("w.sdf"));
}

TEST_F(WorldSdf, MeshesThatAreNotThereOrNoMeshesAreNamed) {
  EXPECT_THAT(error_of(with_geometry("<mesh><uri>meshes/chair.obj</uri></mesh>")),
              AllOf(HasSubstr("collision 'part'"), HasSubstr("chair.obj"), HasSubstr("relative")));
  folder.write("meshes/chair.obj", "this is no mesh");
  EXPECT_THAT(error_of(with_geometry("<mesh><uri>meshes/chair.obj</uri></mesh>")),
              AllOf(HasSubstr("chair.obj"), HasSubstr(".stl")));
}

}  // namespace
}  // namespace swiftlet
