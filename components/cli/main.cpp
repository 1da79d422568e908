// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "components/bag/bag_commands.hpp"
#include "components/bag/live_commands.hpp"
#include "components/cli/completion.hpp"
#include "components/cli/verbs.hpp"
#ifdef SWIFTLET_WITH_SIM
#include "components/experiments/experiment_command.hpp"
#include "components/phone_sim/phone_sim_command.hpp"
#endif
#include "components/introspection/introspection_commands.hpp"
#ifdef SWIFTLET_WITH_SLAM
#include "components/lidar_mapper/map_commands.hpp"
#endif
#include "components/launch/launch_command.hpp"
#include "components/replay/replay_command.hpp"
#include "components/report/report_command.hpp"
#include "components/runtime/component.hpp"
#include "components/runtime/log.hpp"
#include "gcs/gcs_commands.hpp"

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

/// The innermost verb that was typed, or the program.
const CLI::App& typed_verb(const CLI::App& app) {
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
  return *verb;
}

/// "swiftlet gcs goto": what stands before its arguments.
std::string full_name(const CLI::App& verb) {
  const std::string before = verb.get_parent() ? full_name(*verb.get_parent()) + " " : "";
  return before + verb.get_name();
}

/// CLI11 only says that an argument was not expected; a person wants to know which verbs there are.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  std::vector<std::string> names;
  for (const CLI::App* verb :
       typed_verb(app).get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(verb->get_name());
  }
  const std::vector<std::string> rest = app.remaining(true);
  if (names.empty() || rest.empty() || rest.front()[0] == '-') return error.what();
  const std::string near = swiftlet::nearest_word(rest.front(), names);
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return "unknown verb '" + rest.front() + "'; " +
         (near.empty() ? "there are " + all : "did you mean '" + near + "'?");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Swiftlet: a flight stack for small multirotors on plain DDS", "swiftlet"};
  app.require_subcommand(1);
  app.set_version_flag("--version", SWIFTLET_VERSION);
  app.add_option_function<std::string>(
      "--log",
      [](const std::string& level) {
        if (!swiftlet::set_log_level(level)) {
          throw CLI::ValidationError("--log", "is trace, debug, info, warning, error or off");
        }
      },
      "Least important log lines to show: trace, debug, info, warning, error, off");

#ifdef SWIFTLET_WITH_FLY
  swiftlet::add_fly(app);
#endif
  swiftlet::add_run(app);
  swiftlet::add_launch(app);
  swiftlet::add_trajectory(app);
  swiftlet::add_gcs_commands(*app.add_subcommand("gcs", "The ground station: a screen, and verbs for scripts"));
  CLI::App* bag = app.add_subcommand("bag", "Recordings in MCAP");
  bag->require_subcommand(1);
  swiftlet::add_bag_commands(*bag);
  swiftlet::add_live_bag_commands(*bag);
  swiftlet::add_replay(app);
  swiftlet::add_report(app);
#ifdef SWIFTLET_WITH_SLAM
  swiftlet::add_map(app);
#endif
  swiftlet::add_topic_commands(app);
  swiftlet::add_component_commands(app);
  swiftlet::add_param_commands(app);
  swiftlet::add_doctor(app);
#ifdef SWIFTLET_WITH_SIM
  swiftlet::add_experiment(app);
  swiftlet::add_phone_sim(app);
#endif

  // What the shell asks for: "swiftlet complete -- gcs ta" says "takeoff".
  if (argc > 2 && std::string(argv[1]) == "complete" && std::string(argv[2]) == "--") {
    for (const std::string& name : swiftlet::completions(app, {argv + 3, argv + argc})) {
      std::printf("%s\n", name.c_str());
    }
    return 0;
  }
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return app.exit(version);
  } catch (const CLI::RuntimeError& result) {
    return result.get_exit_code();  // the verb has said why
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "swiftlet: %s\nTry: %s --help\n", explain(app, error).c_str(),
                 full_name(typed_verb(app)).c_str());
    return kWrongUsage;
  } catch (const swiftlet::ConfigError& error) {
    std::fprintf(stderr, "swiftlet: %s\n", error.what());
    return kWrongUsage;
  } catch (const swiftlet::RuntimeError& error) {
    std::fprintf(stderr, "swiftlet: %s\n", error.what());
    return kFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "swiftlet: unexpected error: %s\n", error.what());
    return kFailed;
  }
}
