// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "components/runtime/names.hpp"
#include "components/runtime/number_check.hpp"
#include "estimation/basics/whole_file.hpp"
#include "gcs/verbs/cloud_client.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"
#include "perception/cloud_io.hpp"

namespace swiftlet {
namespace {

struct Options {
  std::string file, topic;
  double seconds = 5.0, patience = 5.0, voxel = 0.05;
  bool json = false;
};

/// Before minutes of listening, rather than after.
CloudParams checked(const Options& options) {
  if (const auto form = cloud_form_of(options.file); !form.ok()) {
    end_verb(kExitUnusable, form.error().reason);
  }
  if (const Status place = check_writable(options.file); !place.ok()) {
    end_verb(kExitUnusable, place.error().reason);
  }
  CloudParams params;
  params.topic = options.topic.substr(options.topic.rfind('/', 0) == 0 ? 1 : 0);
  if (!params.topic.empty()) {
    const Status name = check_name(params.topic);
    if (!name.ok()) end_verb(kExitUnusable, "--topic: " + name.error().reason);
  }
  params.length = from_seconds(options.seconds);
  params.patience = from_seconds(options.patience);
  params.voxel = options.voxel;
  return params;
}

void save(const NetworkOptions& network, const Options& options) {
  const CloudParams params = checked(options);
  Terminal terminal;
  Host host(network.host_options("gcs"));
  const auto& client = host.emplace<CloudClient>("gcs", params, terminal);
  host.run();
  terminal.clear();
  if (!client.done()) {
    end_verb(kExitFailed,
             client.problem().empty() ? "interrupted; nothing was written" : client.problem());
  }
  const std::vector<Eigen::Vector3d> points = client.collector().cloud().points();
  const Status saved = save_cloud(points, options.file);
  if (!saved.ok()) end_verb(kExitUnusable, saved.error().reason);
  const int count = client.collector().placed();
  if (options.json) {
    const nlohmann::ordered_json json = {{"file", options.file},
                                         {"points", points.size()},
                                         {"scans", count},
                                         {"seconds", options.seconds}};
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  fmt::print("{}: {} points of {} scans\n", options.file, points.size(), count);
}

}  // namespace

void add_cloud_verbs(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network) {
  CLI::App* group = gcs.add_subcommand("cloud", "What the vehicle's sensors see, in space");
  group->require_subcommand(1);
  const auto options = std::make_shared<Options>();
  CLI::App* verb = group->add_subcommand(
      "save", "Gather scans for a while, place them in the map, and write them as a cloud");
  verb->add_option("file", options->file, "CLOUD.ply or .pcd; it is replaced")->required();
  verb->add_option("--topic", options->topic,
                   "Of type PointCloud2, in the map's frame or in that of a sensor on tf_static; "
                   "else the laser scans");
  verb->add_option("--seconds", options->seconds, "Gather so long [s]")
      ->capture_default_str()
      ->check(within(0.1, 3600.0));
  verb->add_option("--voxel", options->voxel, "Of each cube of so much one point is kept [m]")
      ->capture_default_str()
      ->check(within(0.001, 10.0));
  verb->add_option("--patience", options->patience, "Without any scan, before it gives up [s]")
      ->capture_default_str()
      ->check(within(0.5, 600.0));
  verb->add_flag("--json", options->json, "For scripts");
  verb->footer(
      "Each beam is placed by the odometry of its time. The file appears whole or not at all.\n"
      "Exit codes: 0 written, 1 nothing was heard or could be placed, 2 it cannot be written "
      "there.");
  network->add_to(*verb);
  verb->callback([network, options] { save(*network, *options); });
}

}  // namespace swiftlet
