#pragma once

#include <cstdint>
#include <string>

namespace emulator {

inline constexpr char kXmlFileName[] = "kagami-camera.xml";

/// The GenICam register description of the camera, made from the table of features.
/// @p max_packet_bytes bounds GevSCPSPacketSize.
[[nodiscard]] std::string makeDeviceXml(std::uint32_t max_packet_bytes);

}  // namespace emulator
