// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/plot/figure.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

extern char** environ;

namespace swiftlet::plot {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone with everything in it at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code missing;
    std::string name = (fs::temp_directory_path(missing) / "swiftlet-plot-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs gnuplot on a script, without the settings of whoever runs it.
Status run_gnuplot(const fs::path& script, const fs::path& messages) {
  std::string words[] = {"gnuplot", "--default-settings", script.string()};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  for (const int stream : {1, 2}) {
    posix_spawn_file_actions_addopen(&actions, stream, messages.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0600);
  }
  pid_t process = 0;
  const int failure =
      posix_spawnp(&process, words[0].c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) {
    return Error{
        "figures are drawn by gnuplot, which is not there; install the package gnuplot-nox"};
  }
  if (failure != 0) return Error{fmt::format("gnuplot cannot be run: {}", std::strerror(failure))};
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return Error{fmt::format("gnuplot does not draw the figure: {}", content_of(messages))};
}

Status check(const Figure& figure) {
  if (figure.panels.empty()) return Error{"the figure has no panels"};
  for (const Panel& panel : figure.panels) {
    if (panel.series.empty()) {
      return Error{fmt::format("there is nothing to draw in the panel '{}'", panel.title)};
    }
    for (const Series& series : panel.series) {
      if (series.x.size() != series.y.size() || series.x.empty()) {
        return Error{fmt::format("the series '{}' of the panel '{}' has {} values of x and {} of y",
                                 series.label, panel.title, series.x.size(), series.y.size())};
      }
    }
  }
  return {};
}

}  // namespace

Status Figure::save(const fs::path& file) const {
  if (const Status sound = check(*this); !sound) return sound;
  const ScratchFolder scratch;
  if (scratch.path().empty()) {
    return Error{
        fmt::format("no folder can be made to draw in ({}); set TMPDIR to one that can be "
                    "written to",
                    std::strerror(errno))};
  }
  const fs::path script = scratch.path() / "figure.gp", image = scratch.path() / "figure.png";
  std::ofstream(script) << gnuplot_script(*this, image);
  if (const Status drawn = run_gnuplot(script, scratch.path() / "messages"); !drawn) return drawn;
  std::error_code error;
  if (!fs::exists(image, error)) return Error{"gnuplot has not drawn the figure"};
  fs::copy_file(image, file, fs::copy_options::overwrite_existing, error);
  if (error) {
    return Error{fmt::format("{}: cannot be written ({}); choose another file", file.string(),
                             error.message())};
  }
  return {};
}

}  // namespace swiftlet::plot
