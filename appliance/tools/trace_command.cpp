#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "appliance/tools/commands.h"
#include "appliance/tools/trace_text.h"

namespace appliance {
namespace {

struct Options {
  std::string file;
  std::uint64_t trigger = 0;
  std::uint32_t camera = 0;  // from 1; 0: all
  std::uint64_t picture = 0;
};

void show(const Options& options) {
  const auto trace = readTraceFile(options.file);
  if (!trace) fail(trace.error());
  const auto camera =
      options.camera > 0 ? std::optional<std::uint32_t>(options.camera - 1) : std::nullopt;
  const auto text = options.picture > 0 ? lifeOfPicture(*trace, options.picture)
                    : options.trigger > 0
                        ? lifeOfTrigger(*trace, options.trigger, camera)
                        : std::expected<std::string, std::string>(traceOverview(*trace));
  if (!text) fail(text.error());
  std::fputs(text->c_str(), stdout);
}

}  // namespace

void addTraceCommand(CLI::App& kagami) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = kagami.add_subcommand("trace", "Show the life of a frame or a picture");
  command->add_option("FILE", options->file, "what kagamid wrote ([state] trace)")->required();
  CLI::Option* trigger =
      command->add_option("--trigger", options->trigger, "its frames and their pictures");
  command->add_option("--camera", options->camera, "only this one, from 1")
      ->check(CLI::PositiveNumber)
      ->needs(trigger);
  command->add_option("--picture", options->picture, "this picture and its frame")
      ->excludes(trigger);
  command->callback([options] { show(*options); });
}

}  // namespace appliance
