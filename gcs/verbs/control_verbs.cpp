// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <string>

#include "gcs/verbs/command_options.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

namespace command = swiftlet_msgs::msg::ModeCommand_Constants;

/// A verb whose command may be about another station.
CLI::App* add_verb(CLI::App& control, const std::shared_ptr<GroundOptions>& ground,
                   const char* name, const char* what, std::uint8_t code,
                   const std::shared_ptr<std::string>& successor) {
  CLI::App* verb = control.add_subcommand(name, what);
  const auto options = std::make_shared<CommandOptions>();
  options->add_to(*verb);
  ground->add_to(*verb);
  verb->callback([ground, options, name, code, successor] {
    GroundCommand ground_command;
    ground_command.name = std::string("control ") + name;
    ground_command.command = code;
    ground_command.successor = *successor;
    options->send(*ground, ground_command);
  });
  return verb;
}

}  // namespace

void add_control_verbs(CLI::App& gcs, const std::shared_ptr<GroundOptions>& ground) {
  CLI::App* control = gcs.add_subcommand("control", "Which ground station commands the vehicle");
  control->require_subcommand(1);
  control->footer(
      "One station at a time has control: the first that commands. It keeps it until it gives it\n"
      "away, lets it go, or has not been heard for the commander's control_lease (30 s). Who has\n"
      "it stands in swiftlet gcs status.");
  const auto nobody = std::make_shared<std::string>();
  const auto successor = std::make_shared<std::string>();
  add_verb(*control, ground, "take", "Take control, where no other station has it",
           command::CONTROL_TAKE, nobody);
  add_verb(*control, ground, "give",
           "Hand control over to another station; take undoes it until that one is heard",
           command::CONTROL_GIVE, successor)
      ->add_option("station", *successor, "Its name (--station there; else its host's name)")
      ->required();
  add_verb(*control, ground, "release", "Let control go, to whoever commands next",
           command::CONTROL_RELEASE, nobody);
}

}  // namespace swiftlet
