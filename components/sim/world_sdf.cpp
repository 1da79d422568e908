// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
// World::load: from SDFormat to shapes. The only file that includes SDFormat.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ignition/math/Pose3.hh>
#include <iostream>
#include <mutex>
#include <sdf/sdf.hh>
#include <sstream>

#include "components/runtime/config/config.hpp"
#include "components/sim/mesh_file.hpp"
#include "components/sim/world.hpp"

namespace swiftlet {

namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d to_eigen(const ignition::math::Pose3d& pose) {
  const auto& q = pose.Rot();
  Isometry3d T = Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix();
  T.translation() << pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z();
  return T;
}

Vector3d to_eigen(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

/// Where in the file a shape is described: for messages, and for paths relative to it.
struct Place {
  fs::path file;
  std::string element;  // "model 'office' / link 'walls' / collision 'north'"
};

/// False also for names that no file can have.
bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}
bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

[[noreturn]] void fail(const Place& place, const sdf::ElementPtr& element,
                       const std::string& problem) {
  const bool has_line = element && element->LineNumber().has_value();
  const std::string line = has_line ? fmt::format(":{}", *element->LineNumber()) : "";
  const bool has_file = element && is_there(element->FilePath());
  const std::string file = has_file ? element->FilePath() : place.file.string();
  throw ConfigError(fmt::format("{}{}: {}: {}", file, line, place.element, problem));
}

template <class T>
Isometry3d resolve(const T& thing, const std::string& relative_to, const Place& place) {
  ignition::math::Pose3d pose;
  const sdf::Errors errors = thing.SemanticPose().Resolve(pose, relative_to);
  if (!errors.empty()) {
    fail(place, thing.Element(), errors.front().Message() + "; check 'relative_to' of the pose");
  }
  const Isometry3d T_pose = to_eigen(pose);
  if (!T_pose.matrix().allFinite()) {
    fail(place, thing.Element(), "its pose is not finite; give six finite numbers");
  }
  return T_pose;
}

/// SDFormat fills in a default where a dimension is missing (or misspelt); we want to know.
void demand(const Place& place, const sdf::ElementPtr& geometry, const std::string& kind,
            const std::vector<std::string>& dimensions) {
  const sdf::ElementPtr element = geometry->FindElement(kind);
  for (const std::string& dimension : dimensions) {
    if (!element || !element->HasElement(dimension) ||
        !element->FindElement(dimension)->GetExplicitlySetInFile()) {
      fail(place, element ? element : geometry,
           fmt::format("<{}> has no <{}>; add it", kind, dimension));
    }
  }
}

Shape mesh_shape(const sdf::Mesh& mesh, const Place& place) {
  const fs::path sdf_file = mesh.FilePath().empty() ? place.file : fs::path(mesh.FilePath());
  std::string uri = mesh.Uri();
  for (const char* scheme : {"file://", "model://"}) {
    if (uri.rfind(scheme, 0) == 0) uri.erase(0, std::string(scheme).size());
  }
  const fs::path folder = sdf_file.parent_path();
  fs::path file = folder / uri;
  if (!is_there(file)) file = folder.parent_path() / uri;  // model://name/meshes/...
  if (!is_file(file)) {
    fail(place, mesh.Element(),
         fmt::format("mesh file '{}' is not there; paths are relative to {}", mesh.Uri(),
                     folder.empty() ? "." : folder.string()));
  }
  if (!mesh.Submesh().empty()) {
    fail(place, mesh.Element(), "<submesh> is not supported; put it into a file of its own");
  }
  Result<Shape> shape = read_mesh(file, to_eigen(mesh.Scale()));
  if (!shape) {
    fail(place, mesh.Element(),
         fmt::format("mesh file '{}' cannot be read: {}; export it as .obj, .stl or .dae",
                     file.string(), shape.error().reason));
  }
  return std::move(shape).value();
}

Shape shape_of(const sdf::Collision& collision, const Place& place) {
  const sdf::Geometry* geometry = collision.Geom();
  if (geometry == nullptr) fail(place, collision.Element(), "it has no <geometry>; add one");
  Shape shape;
  switch (geometry->Type()) {
    case sdf::GeometryType::BOX:
      demand(place, geometry->Element(), "box", {"size"});
      shape.kind = Shape::Kind::kBox;
      shape.half_size = 0.5 * to_eigen(geometry->BoxShape()->Size());
      return shape;
    case sdf::GeometryType::CYLINDER:
      demand(place, geometry->Element(), "cylinder", {"radius", "length"});
      shape.kind = Shape::Kind::kCylinder;
      shape.radius = geometry->CylinderShape()->Radius();
      shape.half_length = 0.5 * geometry->CylinderShape()->Length();
      return shape;
    case sdf::GeometryType::SPHERE:
      demand(place, geometry->Element(), "sphere", {"radius"});
      shape.kind = Shape::Kind::kSphere;
      shape.radius = geometry->SphereShape()->Radius();
      return shape;
    case sdf::GeometryType::PLANE: {
      const Vector3d normal = to_eigen(geometry->PlaneShape()->Normal());
      if (!normal.allFinite() || normal.norm() < 1e-9) {
        fail(place, geometry->Element(), "the normal of its plane has no direction");
      }
      shape.kind = Shape::Kind::kPlane;
      shape.T_WS.linear() =
          Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
      return shape;
    }
    case sdf::GeometryType::MESH:
      return mesh_shape(*geometry->MeshShape(), place);
    default:
      fail(place, geometry->Element(),
           "its geometry is not supported; use plane, box, cylinder, sphere or mesh");
  }
}

class Reader {
 public:
  Reader(World& world, fs::path file, const std::vector<std::string>& ground_models)
      : world_(world), file_(std::move(file)), ground_models_(ground_models) {}

  void read(const sdf::Model& model, const Isometry3d& T_WP, const std::string& parents) {
    const std::string name = parents.empty() ? model.Name() : parents + "::" + model.Name();
    const Place place{file_, fmt::format("model '{}'", name)};
    // Without an argument a pose is resolved to the frame that contains it.
    const Isometry3d T_WM = T_WP * resolve(model, "", place);
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      for (std::uint64_t j = 0; j < link.CollisionCount(); ++j) {
        read(*link.CollisionByIndex(j), link.Name(), name, T_WM);
      }
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
      read(*model.ModelByIndex(i), T_WM, name);
    }
  }

 private:
  void read(const sdf::Collision& collision, const std::string& link, const std::string& model,
            const Isometry3d& T_WM) {
    const Place place{file_, fmt::format("model '{}' / link '{}' / collision '{}'", model, link,
                                         collision.Name())};
    const Isometry3d T_MC = resolve(collision, "__model__", place);
    Shape shape = shape_of(collision, place);
    shape.model = model;
    shape.is_ground =
        std::find(ground_models_.begin(), ground_models_.end(), model) != ground_models_.end();
    shape.T_WS = T_WM * T_MC * shape.T_WS;
    const std::string fault = fault_of(shape);
    if (!fault.empty()) fail(place, collision.Element(), fault);
    world_.add(std::move(shape));
  }

  World& world_;
  fs::path file_;
  const std::vector<std::string>& ground_models_;
};

/// Model folders and files that an <include> names: beside the world, or in `models` beside it.
std::string find_included(const fs::path& folder, std::string name) {
  const std::string scheme = "model://";
  if (name.rfind(scheme, 0) == 0) name.erase(0, scheme.size());
  for (const fs::path& candidate : {folder / name, folder / "models" / name}) {
    if (is_there(candidate)) return candidate.string();
  }
  return "";
}

/// Keeps what libraries write to standard error off the screen, as messages of ours. SDFormat says
/// there, and nowhere else, in which line the XML is broken; and it tries a file that is no good as
/// URDF, which complains there about the missing <robot>.
class CapturedStandardError {
 public:
  CapturedStandardError() : lock_(mutex()), stream_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~CapturedStandardError() { std::cerr.rdbuf(stream_); }
  CapturedStandardError(const CapturedStandardError&) = delete;
  CapturedStandardError& operator=(const CapturedStandardError&) = delete;

  /// The first message of SDFormat, without its colours and the place in its source.
  std::string first_message() const {
    const std::string end_of_colour = "\033[0m ";
    const std::string text = text_.str();
    const std::string line = text.substr(0, text.find('\n'));
    const std::size_t colour = line.find(end_of_colour);
    return colour == std::string::npos ? "" : line.substr(colour + end_of_colour.size());
  }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;  // std::cerr is one for the whole program
    return mutex;
  }
  std::ostringstream text_;
  std::lock_guard<std::mutex> lock_;
  std::streambuf* stream_;
};

[[noreturn]] void fail(const fs::path& file, const sdf::Errors& errors,
                       const std::string& first_message) {
  // The last error is the most general one; the first with a line is what to look at.
  const auto with_line = std::find_if(
      errors.begin(), errors.end(), [](const sdf::Error& e) { return e.LineNumber().has_value(); });
  const sdf::Error& error = with_line != errors.end() ? *with_line : errors.front();
  std::string where = error.FilePath().value_or(file.string());
  std::string message = error.Message();
  if (error.LineNumber()) {
    where += fmt::format(":{}", *error.LineNumber());
    if (!first_message.empty()) message += ": " + first_message;
  } else if (!first_message.empty()) {
    message = first_message;
    const std::string before_line = "Line number=";
    const std::size_t begin = message.find(before_line);
    const int line =
        begin == std::string::npos ? 0 : std::atoi(message.c_str() + begin + before_line.size());
    if (line > 0) where += fmt::format(":{}", line);
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  throw ConfigError(
      fmt::format("{}: not a usable SDFormat world: {}; see sdformat.org/spec for what "
                  "belongs here",
                  where, message));
}

/// Of a world whose x axis points east, as ours do.
std::optional<LocalOrigin> origin_of(const sdf::World& world, const fs::path& file) {
  const ignition::math::SphericalCoordinates* coordinates = world.SphericalCoordinates();
  if (coordinates == nullptr) return std::nullopt;
  const GlobalPosition origin{coordinates->LatitudeReference().Degree(),
                              coordinates->LongitudeReference().Degree(),
                              coordinates->ElevationReference()};
  if (!origin.usable()) {
    throw ConfigError(
        fmt::format("{}: <spherical_coordinates> are no place on Earth; give latitude "
                    "and longitude in degrees",
                    file.string()));
  }
  if (coordinates->HeadingOffset().Radian() != 0.0) {
    throw ConfigError(fmt::format(
        "{}: <heading_deg> is not 0; the x axis of a world points east (REP-103)", file.string()));
  }
  return LocalOrigin(origin);
}

}  // namespace

World World::load(const fs::path& file, const std::vector<std::string>& ground_models) {
  if (!is_file(file)) {
    throw ConfigError(fmt::format("{}: world file cannot be read; check the path", file.string()));
  }
  const fs::path folder = file.parent_path();
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetFindCallback([folder](const std::string& name) { return find_included(folder, name); });

  sdf::Root root;
  {
    const CapturedStandardError captured;
    const sdf::Errors errors = root.Load(file.string(), config);
    if (!errors.empty()) fail(file, errors, captured.first_message());
  }
  if (root.WorldCount() == 0) {
    throw ConfigError(
        fmt::format("{}: there is no <world> in it; put the models into "
                    "<sdf><world name=\"...\">",
                    file.string()));
  }
  World world;
  Reader reader(world, file, ground_models);
  const sdf::World& description = *root.WorldByIndex(0);
  for (std::uint64_t i = 0; i < description.ModelCount(); ++i) {
    reader.read(*description.ModelByIndex(i), Isometry3d::Identity(), "");
  }
  world.local_origin_ = origin_of(description, file);
  return world;
}

}  // namespace swiftlet
