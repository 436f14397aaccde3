#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace test {

/// What a screen really got, once.
struct WitnessedScanout {
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::vector<std::uint32_t> pixels;  ///< rows of 0x00rrggbb, no padding
  std::uint64_t vblank = 0;           ///< a frame in which it was scanned out, as vblanks count
};

/// Reads back what VKMS scans out while another program shows it: copies the framebuffer that the
/// plane has, and believes the copy only when the kernel's own checksum of a frame that it sent to
/// the screen is that of these pixels.
///
/// Needs root, as every program in the bed has it, and never becomes the card's master.
/// Errors   Throws std::runtime_error with what the kernel refused.
class ScanoutWitness {
 public:
  /// Once something is shown: a dark screen has no checksums.
  explicit ScanoutWitness(const std::string& card = "/dev/dri/card0");
  ~ScanoutWitness();
  ScanoutWitness(const ScanoutWitness&) = delete;
  ScanoutWitness& operator=(const ScanoutWitness&) = delete;

  /// A picture that is on the screen now; nothing when the screen went dark, or when pictures
  /// change so fast that none could be copied whole before @p timeout.
  [[nodiscard]] std::optional<WitnessedScanout> read(std::chrono::milliseconds timeout);

 private:
  struct Mapping {
    const std::byte* bytes = nullptr;
    std::size_t size = 0;
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::uint32_t stride_bytes = 0;
  };
  struct FrameChecksum {
    std::uint64_t vblank = 0;
    std::uint32_t crc = 0;
  };

  [[nodiscard]] std::uint32_t framebuffer() const;
  [[nodiscard]] const Mapping& map(std::uint32_t framebuffer);
  void fetchChecksums();

  int card_ = -1;
  int checksums_fd_ = -1;
  std::map<std::uint32_t, Mapping> mapped_;
  std::vector<FrameChecksum> checksums_;  // the newest ones, oldest first
};

/// The checksum that VKMS makes of a frame: CRC-32 (reflected 0x04c11db7, from 0, not inverted)
/// over alpha, red, green, blue of 16 bits each.
[[nodiscard]] std::uint32_t vkmsChecksum(std::span<const std::uint32_t> pixels);

}  // namespace test
