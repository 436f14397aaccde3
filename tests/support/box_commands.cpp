#include "tests/support/box_commands.h"

namespace test {
namespace {

std::string addressesOf(const CameraNetwork& network) {
  const std::size_t dot = network.first_address.rfind('.');
  const int first = std::stoi(network.first_address.substr(dot + 1));
  std::string list;
  for (int camera = 0; camera < network.cameras; ++camera) {
    list += (camera > 0 ? ",\"" : "\"") + network.first_address.substr(0, dot + 1) +
            std::to_string(first + camera) + "\"";
  }
  return "[" + list + "]";
}

}  // namespace

std::vector<std::string> emulatorCommand(const CameraNetwork& network, const std::string& size,
                                         const std::filesystem::path& folder,
                                         const std::vector<std::string>& more) {
  std::vector<std::string> command{KAGAMI_EMULATOR,
                                   "--cameras",
                                   std::to_string(network.cameras),
                                   "--size",
                                   size,
                                   "--first-address",
                                   network.first_address,
                                   "--wire-port",
                                   std::to_string(network.wire_port),
                                   "--rig-out",
                                   folder / "rig.toml"};
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

std::vector<std::string> kagamidSettings(const CameraNetwork& network,
                                         const std::filesystem::path& folder,
                                         const std::vector<std::string>& settings) {
  std::vector<std::string> all{"rig.file=" + (folder / "rig.toml").string(),
                               "cameras.addresses=" + addressesOf(network),
                               "cameras.packet_size_bytes=1500",
                               "trigger.wire_port=" + std::to_string(network.wire_port),
                               "trigger.rate_hz=10",
                               "history.sets=40",
                               "display.refresh_hz=20",
                               "display.zoom=1",  // the whole frame, its stamp included
                               "control.bus=none"};
  all.insert(all.end(), settings.begin(), settings.end());
  return all;
}

std::vector<std::string> kagamidCommand(const CameraNetwork& network,
                                        const std::filesystem::path& folder,
                                        const std::vector<std::string>& settings) {
  std::vector<std::string> command{KAGAMID, "--config", KAGAMID_CONFIG};
  for (const std::string& setting : kagamidSettings(network, folder, settings))
    command.insert(command.end(), {"--set", setting});
  return command;
}

}  // namespace test
