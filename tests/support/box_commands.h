#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace test {

/// Emulated cameras on addresses and a trigger wire of the test's own, so that no two tests meet.
struct CameraNetwork {
  std::string first_address;  ///< the last number is the first camera's, the others count on
  int cameras = 1;
  int wire_port = 0;
};

/// kagami-emulator on @p network: it writes rig.toml into @p folder and says "ready".
[[nodiscard]] std::vector<std::string> emulatorCommand(const CameraNetwork& network,
                                                       const std::string& size,
                                                       const std::filesystem::path& folder,
                                                       const std::vector<std::string>& more = {});

/// "key=value", of a daemon on those cameras and on no bus, slow and small enough for any machine.
/// @p settings hold over those made here.
[[nodiscard]] std::vector<std::string> kagamidSettings(
    const CameraNetwork& network, const std::filesystem::path& folder,
    const std::vector<std::string>& settings = {});

/// kagamid with those settings; it says "running:".
[[nodiscard]] std::vector<std::string> kagamidCommand(
    const CameraNetwork& network, const std::filesystem::path& folder,
    const std::vector<std::string>& settings = {});

}  // namespace test
