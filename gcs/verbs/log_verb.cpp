// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "components/runtime/number_check.hpp"
#include "gcs/screen/drawing/surface.hpp"
#include "gcs/screen/shell/locale_text.hpp"
#include "gcs/verbs/log_client.hpp"
#include "gcs/verbs/verb_end.hpp"
#include "gcs/verbs/verbs.hpp"

namespace swiftlet {
namespace {

struct Options {
  std::optional<double> length_s;
  bool json = false, ascii = false;
};

void tell(const NetworkOptions& network, const Options& options) {
  const bool ascii = options.ascii || !screen::locale_is_utf8();
  const auto print = [&](const screen::Event& event) {
    fmt::print("{}\n",
               options.json ? json_line_of(event) : screen::printable(line_of(event), ascii));
    std::fflush(stdout);
  };
  std::optional<Duration> length;
  if (options.length_s) length = from_seconds(*options.length_s);
  Host host(network.host_options("gcs"));
  host.emplace<LogClient>("gcs", length, print);
  if (host.run() != 0) end_verb(kExitFailed, nobody_answers(host.domain()));
}

}  // namespace

void add_log_verb(CLI::App& gcs, const std::shared_ptr<NetworkOptions>& network) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = gcs.add_subcommand("log", "What happens, a line an event, until Ctrl-C");
  verb->add_option("--for", options->length_s, "Only so long [s]")->check(within(0.1, 1e6));
  verb->add_flag("--json", options->json, "For scripts: an object a line");
  verb->add_flag("--ascii", options->ascii, "No other characters, whatever the locale");
  verb->footer(
      "Changes of mode with their reasons, commands accepted and refused, whoever gave them, the "
      "mission,\nthe health of components, battery and link. With --for: exit code 1 where no "
      "vehicle was heard.");
  network->add_to(*verb);
  verb->callback([network, options] { tell(*network, *options); });
}

}  // namespace swiftlet
