// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "perception/map_io.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "estimation/basics/whole_file.hpp"

namespace swiftlet {
namespace {

constexpr std::uint8_t kOccupiedPixel = 0, kFreePixel = 254, kUnknownPixel = 205;
constexpr double kOccupiedThreshold = 0.65;
// With the 0.25 of some tools, the 205 of unknown cells ((255 - 205) / 255 = 0.196) reads as free.
constexpr double kFreeThreshold = 0.196;
constexpr std::uint64_t kMaxPixels = 1ull << 30;

/// Grey values, row by row from the top, and the value of white.
struct Image {
  std::uint64_t width = 0, height = 0, white = 255;
  std::vector<std::uint16_t> pixels;
};

/// A failure to read, inside this file only.
struct ReadFailure {
  std::string problem;
};

std::vector<std::uint8_t> pixels_of(const OccupancyGrid& grid) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(grid.evidence().size());
  for (int y = grid.height() - 1; y >= 0; --y) {
    for (int x = 0; x < grid.width(); ++x) {
      const CellState state = grid.state({x, y});
      pixels.push_back(state == CellState::kOccupied ? kOccupiedPixel
                       : state == CellState::kFree   ? kFreePixel
                                                     : kUnknownPixel);
    }
  }
  return pixels;
}

/// Reads a netpbm header number, over white space and comments.
std::uint64_t read_number(const std::string& data, std::size_t& at, const char* name) {
  while (at < data.size() &&
         (std::isspace(static_cast<unsigned char>(data[at])) != 0 || data[at] == '#')) {
    if (data[at] == '#') {
      while (at < data.size() && data[at] != '\n') ++at;
    } else {
      ++at;
    }
  }
  std::uint64_t number = 0;
  const std::size_t begin = at;
  while (at < data.size() && data[at] >= '0' && data[at] <= '9' && at - begin < 10) {
    number = 10 * number + static_cast<std::uint64_t>(data[at++] - '0');
  }
  if (at == begin) throw ReadFailure{fmt::format("a number for its {} is missing", name)};
  return number;
}

Image read_pgm(const std::string& data) {
  const bool binary = data[1] == '5';
  std::size_t at = 2;
  Image image;
  image.width = read_number(data, at, "width");
  image.height = read_number(data, at, "height");
  image.white = read_number(data, at, "white");
  if (image.width == 0 || image.height == 0 || image.width > kMaxPixels ||
      image.height > kMaxPixels || image.width * image.height > kMaxPixels) {
    throw ReadFailure{fmt::format("it claims {} x {} pixels", image.width, image.height)};
  }
  if (image.white == 0 || image.white > 65535) {
    throw ReadFailure{fmt::format("its white is {}, not from 1 to 65535", image.white)};
  }
  const std::uint64_t count = image.width * image.height;
  const std::uint64_t bytes = image.white > 255 ? 2 : 1;
  if (binary) ++at;  // the one character of white space after the header
  const std::uint64_t left = data.size() > at ? data.size() - at : 0;
  if (left < (binary ? count * bytes : count)) {
    throw ReadFailure{
        fmt::format("it ends early: {} x {} pixels are promised", image.width, image.height)};
  }
  image.pixels.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t value = 0;
    if (!binary) {
      value = read_number(data, at, "pixels");
    } else {
      for (std::uint64_t b = 0; b < bytes; ++b) {
        value = 256 * value + static_cast<unsigned char>(data[at++]);
      }
    }
    if (value > image.white) {
      throw ReadFailure{fmt::format("a pixel is {}, above its white of {}", value, image.white)};
    }
    image.pixels.push_back(static_cast<std::uint16_t>(value));
  }
  return image;
}

Image read_with_opencv(const std::string& data) {
  cv::Mat grey;
  try {
    const std::vector<std::uint8_t> buffer(data.begin(), data.end());
    grey = cv::imdecode(buffer, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    grey.release();
  }
  if (grey.empty()) throw ReadFailure{"it is not an image that can be read"};
  Image image;
  image.width = static_cast<std::uint64_t>(grey.cols);
  image.height = static_cast<std::uint64_t>(grey.rows);
  for (int y = 0; y < grey.rows; ++y) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
    image.pixels.insert(image.pixels.end(), row, row + grey.cols);
  }
  return image;
}

Image read_image(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw ReadFailure{"it cannot be opened"};
  const std::string data((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (data.size() < 3) throw ReadFailure{"it is empty or too short for an image"};
  if (data[0] == 'P' && (data[1] == '5' || data[1] == '2')) return read_pgm(data);
  return read_with_opencv(data);
}

/// What the .yaml says.
struct MapFile {
  std::string image;
  double resolution = 0.0;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  bool negate = false;
  bool scale = false;
  double occupied_threshold = 0.0, free_threshold = 0.0;
};

double read_double(const YAML::Node& node, const char* key, double min, double max) {
  if (!node) throw ReadFailure{fmt::format("'{}' is missing", key)};
  double value = NAN;
  try {
    value = node.as<double>();
  } catch (const YAML::Exception&) {
    throw ReadFailure{fmt::format("'{}' is not a number", key)};
  }
  if (!(value >= min && value <= max)) {
    throw ReadFailure{fmt::format("'{}' is {}, not from {} to {}", key, value, min, max)};
  }
  return value;
}

MapFile read_yaml(const std::filesystem::path& file) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw ReadFailure{"it cannot be opened"};
  } catch (const YAML::Exception& error) {
    throw ReadFailure{fmt::format("it is not YAML: {}", error.what())};
  }
  if (!root.IsMap()) throw ReadFailure{"it is not a mapping with the keys of a map"};
  MapFile map;
  if (!root["image"] || !root["image"].IsScalar() || root["image"].Scalar().empty()) {
    throw ReadFailure{"'image' is missing"};
  }
  map.image = root["image"].Scalar();
  map.resolution = read_double(root["resolution"], "resolution", 1e-4, 1e3);
  const YAML::Node origin = root["origin"];
  if (!origin || !origin.IsSequence() || origin.size() < 2 || origin.size() > 3) {
    throw ReadFailure{"'origin' is not a list of x, y and yaw"};
  }
  map.origin.x() = read_double(origin[0], "origin", -1e7, 1e7);
  map.origin.y() = read_double(origin[1], "origin", -1e7, 1e7);
  if (origin.size() == 3 && read_double(origin[2], "origin", -1e7, 1e7) != 0.0) {
    throw ReadFailure{"'origin' turns the map; only maps with a yaw of 0 can be read"};
  }
  map.occupied_threshold = read_double(root["occupied_thresh"], "occupied_thresh", 1e-6, 1 - 1e-6);
  map.free_threshold = read_double(root["free_thresh"], "free_thresh", 1e-6, 1 - 1e-6);
  if (map.free_threshold >= map.occupied_threshold) {
    throw ReadFailure{"'free_thresh' is not below 'occupied_thresh'"};
  }
  if (const YAML::Node negate = root["negate"]) {
    const std::string word = negate.IsScalar() ? negate.Scalar() : "";
    if (word != "0" && word != "1" && word != "false" && word != "true") {
      throw ReadFailure{"'negate' is neither 0 nor 1"};
    }
    map.negate = word == "1" || word == "true";
  }
  if (const YAML::Node mode = root["mode"]) {
    const std::string word = mode.IsScalar() ? mode.Scalar() : "";
    if (word != "trinary" && word != "scale") {
      throw ReadFailure{fmt::format("'mode' is '{}'; known are trinary and scale", word)};
    }
    map.scale = word == "scale";
  }
  return map;
}

void fill(OccupancyGrid& grid, const Image& image, const MapFile& map) {
  for (int y = 0; y < grid.height(); ++y) {
    for (int x = 0; x < grid.width(); ++x) {
      const auto row = image.height - 1 - static_cast<std::uint64_t>(y);
      const double value =
          static_cast<double>(image.pixels[row * image.width + static_cast<std::uint64_t>(x)]) /
          static_cast<double>(image.white);
      const double darkness = map.negate ? value : 1.0 - value;
      if (darkness > map.occupied_threshold) {
        grid.set_state({x, y}, CellState::kOccupied);
      } else if (darkness < map.free_threshold) {
        grid.set_state({x, y}, CellState::kFree);
      } else if (map.scale) {
        grid.set_probability({x, y}, darkness);
      }
    }
  }
}

Status check_form(const std::filesystem::path& image) {
  const std::string extension = image.extension().string();
  if (extension == ".pgm" || extension == ".png") return {};
  return Error{fmt::format("{}: a map is saved as .pgm or .png", image.string())};
}

}  // namespace

Status check_map_file(const std::filesystem::path& image) {
  if (Status form = check_form(image); !form) return form;
  return check_writable(image);
}

Status save_map(const OccupancyGrid& grid, const std::filesystem::path& image) {
  if (Status form = check_form(image); !form) return form;
  if (grid.empty()) {
    return Error{fmt::format("{}: the map is empty, there is nothing to save", image.string())};
  }
  std::vector<std::uint8_t> pixels = pixels_of(grid);
  if (image.extension() == ".png") {
    std::vector<std::uint8_t> png;
    const cv::Mat picture(grid.height(), grid.width(), CV_8UC1, pixels.data());
    try {
      if (!cv::imencode(".png", picture, png)) png.clear();
    } catch (const cv::Exception&) {
      png.clear();
    }
    if (png.empty()) return Error{fmt::format("{}: cannot be encoded", image.string())};
    return write_whole(image, std::string(png.begin(), png.end()));
  }
  std::string pgm = fmt::format("P5\n{} {}\n255\n", grid.width(), grid.height());
  pgm.append(pixels.begin(), pixels.end());
  if (Status status = write_whole(image, pgm); !status) return status;
  const Eigen::Vector2d origin = grid.origin();
  return write_whole(
      std::filesystem::path(image).replace_extension(".yaml"),
      fmt::format("image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0]\nnegate: 0\n"
                  "occupied_thresh: {}\nfree_thresh: {}\n",
                  YAML::Dump(YAML::Node(image.filename().string())), grid.resolution(), origin.x(),
                  origin.y(), kOccupiedThreshold, kFreeThreshold));
}

Result<OccupancyGrid> load_map(const std::filesystem::path& yaml,
                               const OccupancyGrid::Params& params) {
  std::filesystem::path file = yaml;
  try {
    const MapFile map = read_yaml(yaml);
    file = yaml.parent_path() / map.image;
    const Image image = read_image(file);
    OccupancyGrid::Params grid_params = params;
    grid_params.resolution = map.resolution;
    grid_params.occupied_threshold = map.occupied_threshold;
    grid_params.free_threshold = map.free_threshold;
    if (static_cast<std::int64_t>(image.width * image.height) > params.max_cells) {
      throw ReadFailure{fmt::format("its {} x {} pixels are more than the limit of {} cells",
                                    image.width, image.height, params.max_cells)};
    }
    OccupancyGrid grid(grid_params, map.origin, static_cast<int>(image.width),
                       static_cast<int>(image.height));
    if (grid.empty()) throw ReadFailure{"the parameters of the occupancy grid are out of range"};
    fill(grid, image, map);
    return grid;
  } catch (const ReadFailure& failure) {
    return Error{fmt::format("{}: {}", file.string(), failure.problem)};
  }
}

}  // namespace swiftlet
