#include <cstdio>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>

#include "appliance/config/config.h"
#include "appliance/tools/commands.h"

namespace appliance {

void addConfigCommand(CLI::App& kagami) {
  CLI::App* config = kagami.add_subcommand("config", "Look after the configuration");
  config->require_subcommand(1);

  struct Options {
    std::string file;
    std::vector<std::string> overrides;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* check = config->add_subcommand("check", "Say whether kagamid would take this file");
  check->add_option("FILE", options->file)->required();
  check->add_option("--set", options->overrides, "section.key=value, as for kagamid")
      ->allow_extra_args(false);
  check->callback([options] {
    const auto loaded = loadConfig(options->file, options->overrides);
    if (!loaded) fail(loaded.error());
    for (const std::string& warning : loaded->warnings)
      std::fprintf(stderr, "kagami: warning: %s\n", warning.c_str());
    std::printf("%s: valid\n", options->file.c_str());
  });

  config->add_subcommand("keys", "List every key")->callback([] {
    for (const std::string& key : configKeys()) std::printf("%s\n", key.c_str());
  });
}

}  // namespace appliance
