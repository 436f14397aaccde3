#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "appliance/geometry/coverage_text.h"
#include "appliance/geometry/rig_file.h"
#include "appliance/network/uplink_text.h"
#include "appliance/site/site_light.h"
#include "appliance/site/site_plan.h"
#include "appliance/tools/commands.h"

namespace appliance {
namespace {

struct Options {
  std::string config;
  std::vector<std::string> overrides;
  std::optional<std::uint32_t> cameras, width_px, height_px, packet_size_bytes;
  std::optional<double> rate_hz, camera_link_gbps, exposure_us, mains_hz;
  std::vector<std::string> uplinks;
  std::string screen = "1920x1080";
};

/// "1920x1080"
ViewParameters screenOf(const std::string& text) {
  ViewParameters screen;
  char end = 0;
  if (std::sscanf(text.c_str(), "%5ux%5u%c", &screen.width_px, &screen.height_px, &end) != 2 ||
      screen.width_px == 0 || screen.height_px == 0)
    fail("--screen " + text + ": not of the form WIDTHxHEIGHT, such as 1920x1080");
  return screen;
}

struct Site {
  NetworkParameters network;
  LightParameters light;
  std::vector<std::string> picture;  ///< what the screen shows; empty without a rig
};

/// Of the configuration and its rig, where one is named.
Site configuredSite(const Options& options) {
  Site site;
  if (options.config.empty()) return site;
  const auto config = loadConfig(options.config, options.overrides);
  if (!config) fail(config.error());
  const auto rig = loadRig(config->rig.file);
  if (!rig) fail(rig.error());
  for (const std::string& warning : rig->warnings)
    std::fprintf(stderr, "kagami: warning: %s\n", warning.c_str());
  const ViewParameters screen = screenOf(options.screen);
  site.picture = coverLines(*rig, screen.width_px, screen.height_px, config->display.zoom);
  site.network = networkParameters(*config, *rig);
  site.light = lightParameters(*config, *rig);
  return site;
}

Site siteOf(const Options& options) {
  Site site = configuredSite(options);
  site.network.cameras = options.cameras.value_or(site.network.cameras);
  site.network.width_px = options.width_px.value_or(site.network.width_px);
  site.network.height_px = options.height_px.value_or(site.network.height_px);
  site.network.rate_hz = options.rate_hz.value_or(site.network.rate_hz);
  site.network.packet_size_bytes =
      options.packet_size_bytes.value_or(site.network.packet_size_bytes);
  site.network.camera_link_gbps = options.camera_link_gbps.value_or(site.network.camera_link_gbps);
  site.light.rate_hz = site.network.rate_hz;
  site.light.exposure_us = options.exposure_us.value_or(site.light.exposure_us);
  site.light.mains_hz = options.mains_hz.value_or(site.light.mains_hz);
  return site;
}

void printPlan(const NetworkParameters& network, const NetworkPlan& plan) {
  const auto us = [](rt::Nanoseconds t) { return static_cast<double>(t.count()) * 1e-3; };
  std::printf("%-14s %8.3g Gb/s %4.0f %% %10.1f us %8.1f ms %8.2f MB %8.2f MB %9.1f Hz\n",
              uplinkWords(network).c_str(), plan.uplink_gbps, 100 * plan.uplink_use,
              us(plan.packet_delay), us(plan.transfer) * 1e-3,
              static_cast<double>(plan.buffer_bytes) * 1e-6,
              static_cast<double>(plan.undelayed_bytes) * 1e-6, plan.highest_rate_hz);
}

void printRefusal(const NetworkParameters& network, const NetworkRefusal& refusal) {
  std::printf("%-14s impossible: %s\n", uplinkWords(network).c_str(),
              textOf(refusal.reason).c_str());
  const char* lead = "possible:";
  for (const NetworkAlternative& alternative : refusal.alternatives) {
    std::printf("%-14s   %-9s %s\n", "", lead, textOf(alternative.change).c_str());
    lead = "or:";
  }
}

/// Whether @p network is possible.
bool print(const NetworkParameters& network) {
  const auto plan = planNetwork(network);
  if (plan)
    printPlan(network, *plan);
  else
    printRefusal(network, plan.error());
  return plan.has_value();
}

/// What to print: the named uplinks, else three usual ones, with the configured one if it is
/// another.
std::vector<Uplinks> uplinksToPrint(const Options& options, const NetworkParameters& network) {
  std::vector<Uplinks> all;
  for (const std::string& text : options.uplinks) {
    const auto uplinks = parseUplinks(text);
    if (!uplinks) fail("--uplink " + uplinks.error());
    all.push_back(*uplinks);
  }
  if (!all.empty()) return all;
  all = {{1, 10}, {2, 10}, {1, 25}};
  const Uplinks configured{network.uplinks, network.uplink_gbps};
  if (!options.config.empty() && std::ranges::find(all, configured) == all.end())
    all.push_back(configured);
  return all;
}

void plan(const Options& options) {
  Site site = siteOf(options);
  NetworkParameters& network = site.network;
  const bool judged = !options.config.empty() || !options.uplinks.empty();
  const Uplinks configured{network.uplinks, network.uplink_gbps};
  const std::vector<Uplinks> all = uplinksToPrint(options, network);
  std::printf("%u cameras of %ux%u at %.4g Hz, packets of %u bytes, %.4g Gb/s per camera\n\n",
              network.cameras, network.width_px, network.height_px, network.rate_hz,
              network.packet_size_bytes, network.camera_link_gbps);
  std::printf("%-14s %13s %6s %13s %11s %11s %11s %12s\n", "uplinks", "fullest", "use",
              "packet delay", "transfer", "buffer", "undelayed", "highest rate");
  bool possible = true;
  for (const Uplinks& uplinks : all) {
    network.uplinks = uplinks.count;
    network.uplink_gbps = uplinks.gbps;
    const bool fits = print(network);
    if (!options.uplinks.empty() || uplinks == configured) possible = possible && fits;
  }
  std::printf("\n");
  for (const Phrase& line : lightLines(site.light)) std::printf("%s\n", textOf(line).c_str());
  if (!site.picture.empty()) std::printf("\n");
  for (const std::string& line : site.picture) std::printf("%s\n", line.c_str());
  if (judged && !possible) throw CommandFailed();
}

}  // namespace

void addPlanCommand(CLI::App& kagami) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = kagami.add_subcommand(
      "plan",
      "Say what the network can carry, what the light does to the exposure, and how the pictures "
      "fill the screen");
  command->footer(
      "buffer: what the switch must hold for one uplink; undelayed: the same without the packet\n"
      "delay. Without options for them, --config's values are planned, else 20 cameras of "
      "1280x1024\n"
      "at 40 Hz. Ends with 1 where the configured uplinks, or those of --uplink, carry too "
      "little.");
  command->add_option("--config", options->config, "plan for this configuration and its rig");
  command->add_option("--set", options->overrides, "section.key=value, as for kagamid")
      ->needs("--config")
      ->allow_extra_args(false);
  command->add_option("--cameras", options->cameras)->check(CLI::Range(1, 64));
  command->add_option("--width", options->width_px, "pixels")->check(CLI::Range(16, 16384));
  command->add_option("--height", options->height_px, "pixels")->check(CLI::Range(16, 16384));
  command->add_option("--fps", options->rate_hz, "triggers a second")
      ->check(CLI::Range(0.1, 1000.0));
  command->add_option("--packet-size", options->packet_size_bytes, "bytes, the IP datagram")
      ->check(CLI::Range(576, 16000));
  command->add_option("--uplink", options->uplinks, "10G, 2x10G, 25G, ...; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--camera-link", options->camera_link_gbps, "of each camera, in Gb/s")
      ->check(CLI::Range(0.1, 100.0));
  command->add_option("--screen", options->screen, "its size in pixels, as it hangs")
      ->capture_default_str();
  command->add_option("--exposure-us", options->exposure_us)->check(CLI::Range(1.0, 1e6));
  command->add_option("--mains", options->mains_hz, "50 or 60 Hz")->check(CLI::Range(10.0, 100.0));
  command->callback([options] { plan(*options); });
}

}  // namespace appliance
