#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "appliance/control/control_client.h"
#include "appliance/tools/commands.h"
#include "appliance/tools/metrics_listing.h"

namespace appliance {
namespace {

void showMetrics(const ControlPlace& place, bool as_json) {
  auto client = ControlClient::open(place.bus, place.name);
  if (!client) fail(client.error());
  const auto metrics = client->metrics();
  if (!metrics) fail(metrics.error());
  if (as_json) {
    std::printf("%s\n", metrics->c_str());
    return;
  }
  const auto listing = metricsListing(*metrics);
  if (!listing) fail(listing.error());
  std::fputs(listing->c_str(), stdout);
}

}  // namespace

void addMetricsCommand(CLI::App& kagami, const ControlPlace& place) {
  CLI::App* command = kagami.add_subcommand("metrics", "What the daemon counts about itself");
  const auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "as one JSON object");
  command->callback([&place, as_json] { showMetrics(place, *as_json); });
}

}  // namespace appliance
