#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/emulated/rig/gvcp.h"
#include "rt/clock.h"

namespace emulator {

struct SizePx {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const SizePx&, const SizePx&) = default;
};

/// What makes one camera itself.
struct Identity {
  std::uint32_t number = 0;       ///< from 0; serial number and MAC address follow
  std::uint32_t address = 0;      ///< IPv4, host order
  std::uint32_t subnet_mask = 0;  ///< host order
  std::string user_name;
  SizePx sensor;
  rt::Nanoseconds opto_delay{};  ///< from the edge on Line1's wire to the sensor's logic
};

/// The register space of one camera: bootstrap registers, features, the GenICam file.
///
/// Answers whether a client's access is allowed and holds the values; what a write makes
/// the camera do is the camera's business.
class Registers {
 public:
  static constexpr std::uint32_t kXmlAddress = 0x10000;
  static constexpr std::size_t kDiscoveryBytes = 0xf8;

  /// In the state of a camera that was just switched on. @p xml outlives the registers.
  Registers(const Identity& identity, std::uint32_t max_packet_bytes, std::span<const char> xml);

  /// The camera's own access: any address below kXmlAddress, a multiple of 4.
  [[nodiscard]] std::uint32_t get(std::uint32_t address) const;
  [[nodiscard]] float getFloat(std::uint32_t address) const;
  void set(std::uint32_t address, std::uint32_t value);

  /// A client's access.
  [[nodiscard]] gvcp::Status checkRead(std::uint32_t address) const;
  /// kSuccess says that set(address, value) may follow.
  [[nodiscard]] gvcp::Status checkWrite(std::uint32_t address, std::uint32_t value,
                                        bool acquiring) const;
  /// Whole words of memory or of the GenICam file.
  [[nodiscard]] gvcp::Status readMemory(std::uint32_t address, std::span<std::uint8_t> out) const;

  /// The first kDiscoveryBytes bytes are the answer to a discovery.
  [[nodiscard]] std::span<const std::uint8_t> discoveryAnswer() const;

 private:
  enum class Access : std::uint8_t { kNone, kRead, kReadWrite, kWrite };

  void allow(std::uint32_t address, std::uint32_t bytes, Access access);
  void setText(std::uint32_t address, std::size_t capacity, const std::string& text);
  void describeBootstrap(const Identity& identity);
  [[nodiscard]] gvcp::Status checkRegion(std::uint32_t address, std::uint32_t value) const;

  std::uint32_t max_packet_bytes_;
  std::span<const char> xml_;
  std::vector<std::uint8_t> bytes_;
  std::vector<Access> access_;  // per word
};

}  // namespace emulator
