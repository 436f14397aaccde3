#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "appliance/config/text_file.h"
#include "appliance/config/toml_reader.h"
#include "appliance/control/control_client.h"
#include "appliance/tools/commands.h"
#include "appliance/tools/metrics_listing.h"
#include "appliance/tools/status_text.h"

namespace appliance {
namespace {

constexpr double kLongestDelay_s = 3600;  // far more than memory holds; the daemon knows its own

ControlClient connect(const ControlPlace& place) {
  auto client = ControlClient::open(place.bus, place.name);
  if (!client) fail(client.error());
  return std::move(*client);
}

void expectDone(const ControlClient::Answer& answer) {
  if (!answer) fail(answer.error());
}

void showStatus(const ControlPlace& place, bool as_json) {
  ControlClient client = connect(place);
  const auto status = client.status();
  if (!status) fail(status.error());
  if (as_json) {
    std::printf("%s\n", withMetrics(*status, client.metrics().value_or("")).c_str());
    return;
  }
  const auto text = statusText(*status);
  if (!text) fail(text.error());
  std::fputs(text->c_str(), stdout);
}

/// Runs @p command and returns its exit status.
int runToItsEnd(std::vector<std::string> command) {
  std::vector<char*> argv;
  for (std::string& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = -1;
  if (const int r = posix_spawnp(&child, argv.front(), nullptr, nullptr, argv.data(), environ);
      r != 0)
    fail(command.front() + ": cannot be started (" + std::strerror(r) + ")");
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C is for the command; this one ends after it
  int status = 0;
  if (waitpid(child, &status, 0) != child) return 1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void waitForCtrlC() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  int came = 0;
  (void)sigwait(&signals, &came);
}

/// The screen comes back when this connection ends, however it ends.
void releaseScreen(const ControlPlace& place, std::vector<std::string> command) {
  ControlClient client = connect(place);
  expectDone(client.releaseScreen());
  if (!command.empty() && command.front() == "--") command.erase(command.begin());
  if (command.empty()) {
    std::puts("the screen is free until this command ends (Ctrl-C)");
    std::fflush(stdout);
    waitForCtrlC();
    return;
  }
  if (const int status = runToItsEnd(std::move(command)); status != 0)
    throw CLI::RuntimeError(status);
}

void loadRig(const ControlPlace& place, const std::string& path) {
  const auto text = readTextFile(path);
  if (!text) fail(text.error());
  // The bus would refuse other text than UTF-8 without saying why.
  if (const auto parsed = TomlFile::parse(*text, path); !parsed) fail(parsed.error());
  const auto warnings = connect(place).loadRig(*text, path);
  if (!warnings) fail(warnings.error());
  std::fputs(warnings->c_str(), stderr);
  std::printf("%s: in use until kagamid ends\n", path.c_str());
}

std::uint32_t inMilliseconds(double time_s) {
  return static_cast<std::uint32_t>(std::lround(time_s * 1e3));
}

void addPlaybackCommands(CLI::App& kagami, const ControlPlace& place) {
  CLI::App* speed = kagami.add_subcommand("speed", "Play from the shown moment in slow motion");
  const auto rate = std::make_shared<std::string>();
  speed->add_option("SPEED", *rate, "1, 1/2, 1/4, 1/8, or 0 to stop")->required();
  speed->callback([&place, rate] { expectDone(connect(place).setSpeed(*rate)); });

  CLI::App* replay = kagami.add_subcommand("replay", "Show the last seconds once more");
  const auto back_s = std::make_shared<double>(0);
  const auto replay_rate = std::make_shared<std::string>("1/2");
  replay->add_option("SECONDS", *back_s)->required()->check(CLI::Range(0.0, kLongestDelay_s));
  replay->add_option("SPEED", *replay_rate, "1, 1/2, 1/4 or 1/8")->capture_default_str();
  replay->callback([&place, back_s, replay_rate] {
    expectDone(connect(place).replay(inMilliseconds(*back_s), *replay_rate));
  });
}

void addCompareCommand(CLI::App& kagami, const ControlPlace& place) {
  struct Options {
    std::string layout;
    std::uint32_t view = 0;
    double earlier_s = 0;
    double share = 0.5;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* compare = kagami.add_subcommand(
      "compare", "Show a second view or an earlier moment in the same picture");
  compare->add_option("LAYOUT", options->layout, "side-by-side, ghost or wipe; single ends it")
      ->required();
  compare->add_option("--view", options->view, "the second view, from 1; usually the first's own");
  compare->add_option("--earlier", options->earlier_s, "seconds before the first")
      ->check(CLI::Range(0.0, kLongestDelay_s));
  compare
      ->add_option("--share", options->share,
                   "opacity of a ghost, or the part of the width that a wipe leaves to the first")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  compare->callback([&place, options] {
    expectDone(connect(place).compare(options->layout, options->view,
                                      inMilliseconds(options->earlier_s), options->share));
  });
}

void addTargetCommand(CLI::App& kagami, const ControlPlace& place) {
  CLI::App* target = kagami.add_subcommand("target", "Set the point that stays in the centre");
  const auto target_m = std::make_shared<std::vector<double>>();
  CLI::Option* position = target
                              ->add_option("POSITION", *target_m,
                                           "metres in the rig frame, +Z up; holds from the "
                                           "shown moment on")
                              ->expected(3)
                              ->delimiter(',');
  const auto release = std::make_shared<bool>(false);
  target->add_flag("--release", *release, "follow what is measured again, or the rig's point")
      ->excludes(position);
  target->callback([&place, target_m, release] {
    if (*release) {
      expectDone(connect(place).releaseTarget());
      return;
    }
    if (target_m->empty()) throw CLI::RequiredError("POSITION or --release");
    expectDone(connect(place).setTarget({(*target_m)[0], (*target_m)[1], (*target_m)[2]}));
  });
}

/// What needs the right to maintain: docs/dbus.md.
void addMaintenanceCommands(CLI::App& kagami, const ControlPlace& place) {
  CLI::App* rig = kagami.add_subcommand("rig", "Use another calibration while the box runs");
  rig->require_subcommand(1);
  CLI::App* load = rig->add_subcommand("load", "Use this rig file from the next picture on");
  const auto rig_file = std::make_shared<std::string>();
  load->add_option("FILE", *rig_file, "for the running cameras")->required();
  load->callback([&place, rig_file] { loadRig(place, *rig_file); });

  CLI::App* screen = kagami.add_subcommand("screen", "Give the screen to another program");
  screen->require_subcommand(1);
  CLI::App* lend = screen->add_subcommand(
      "release", "Show nothing while COMMAND runs, or until Ctrl-C; capture goes on");
  lend->prefix_command();
  lend->callback([&place, lend] { releaseScreen(place, lend->remaining()); });
  screen->add_subcommand("take", "Show pictures again")->callback([&place] {
    expectDone(connect(place).takeScreen());
  });
}

}  // namespace

void addControlCommands(CLI::App& kagami, const ControlPlace& place) {
  addPlaybackCommands(kagami, place);
  CLI::App* status =
      kagami.add_subcommand("status", "Show what is on the screen and the state of every part");
  const auto as_json = std::make_shared<bool>(false);
  status->add_flag("--json", *as_json, "as one JSON object");
  status->callback([&place, as_json] { showStatus(place, *as_json); });

  CLI::App* mode = kagami.add_subcommand("mode", "Change the mode");
  const auto name = std::make_shared<std::string>();
  mode->add_option("MODE", *name, "live, frozen or sweep")->required();
  mode->callback([&place, name] { expectDone(connect(place).setMode(*name)); });

  CLI::App* delay = kagami.add_subcommand("delay", "Show what was this long ago; 0 is live");
  const auto delay_s = std::make_shared<double>(0);
  delay->add_option("SECONDS", *delay_s)->required()->check(CLI::Range(0.0, kLongestDelay_s));
  delay->callback(
      [&place, delay_s] { expectDone(connect(place).setDelay(inMilliseconds(*delay_s))); });

  CLI::App* view = kagami.add_subcommand("view", "Show another view");
  const auto number = std::make_shared<std::uint32_t>(0);
  view->add_option("VIEW", *number, "from 1, along the arc")->required();
  view->callback([&place, number] { expectDone(connect(place).setView(*number)); });

  addCompareCommand(kagami, place);
  addTargetCommand(kagami, place);

  kagami.add_subcommand("freeze", "Stop at the shown moment")->callback([&place] {
    expectDone(connect(place).freeze());
  });
  kagami.add_subcommand("thaw", "Go on as before the stop")->callback([&place] {
    expectDone(connect(place).thaw());
  });
  kagami.add_subcommand("sweep", "Walk through all views of the stopped moment")
      ->callback([&place] { expectDone(connect(place).sweep()); });

  addMaintenanceCommands(kagami, place);
}

}  // namespace appliance
