#include "tests/kernel/support/scanout_witness.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "tests/kernel/support/files.h"

namespace test {
namespace {

constexpr std::size_t kKeptChecksums = 64;

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

template <class T, void (*Free)(T*)>
struct Freed {
  void operator()(T* object) const { Free(object); }
};
template <class T, void (*Free)(T*)>
using Owned = std::unique_ptr<T, Freed<T, Free>>;

constexpr std::array<std::uint32_t, 256> crcTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ ((value & 1) != 0 ? 0xedb88320U : 0);
    table[i] = value;
  }
  return table;
}

/// "/dev/dri/card0" -> "0", its folder in debugfs.
std::string minorOf(const std::string& card) {
  return card.substr(card.find_first_of("0123456789"));
}

}  // namespace

std::uint32_t vkmsChecksum(std::span<const std::uint32_t> pixels) {
  static constexpr auto kTable = crcTable();
  std::uint32_t crc = 0;
  const auto feed = [&crc](std::uint32_t channel) {
    // Eight bits become sixteen by repeating them.
    crc = kTable[(crc ^ channel) & 255] ^ crc >> 8;
    crc = kTable[(crc ^ channel) & 255] ^ crc >> 8;
  };
  for (const std::uint32_t pixel : pixels) {
    feed(255);
    feed(pixel >> 16 & 255);
    feed(pixel >> 8 & 255);
    feed(pixel & 255);
  }
  return crc;
}

ScanoutWitness::ScanoutWitness(const std::string& card)
    : card_(::open(card.c_str(), O_RDWR | O_CLOEXEC)) {
  if (card_ < 0) refuse("cannot open " + card);
  drmDropMaster(card_);  // the first to open a card is made its master
  drmSetClientCap(card_, DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1);
  const std::string folder = "/sys/kernel/debug/dri/" + minorOf(card) + "/crtc-0/crc/";
  writeAttribute(folder + "control", "auto");
  // From opening on, every frame is summed.
  checksums_fd_ = ::open((folder + "data").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (checksums_fd_ < 0) {
    ::close(card_);
    refuse("cannot open " + folder + "data");
  }
}

ScanoutWitness::~ScanoutWitness() {
  for (const auto& [id, mapping] : mapped_) {
    ::munmap(const_cast<std::byte*>(mapping.bytes), mapping.size);
  }
  ::close(checksums_fd_);
  ::close(card_);
}

std::uint32_t ScanoutWitness::framebuffer() const {
  const Owned<drmModePlaneRes, drmModeFreePlaneResources> planes(drmModeGetPlaneResources(card_));
  if (!planes) refuse("no planes");
  for (std::uint32_t i = 0; i < planes->count_planes; ++i) {
    const Owned<drmModePlane, drmModeFreePlane> plane(drmModeGetPlane(card_, planes->planes[i]));
    if (plane && plane->crtc_id != 0 && plane->fb_id != 0) return plane->fb_id;
  }
  return 0;
}

const ScanoutWitness::Mapping& ScanoutWitness::map(std::uint32_t framebuffer) {
  if (const auto found = mapped_.find(framebuffer); found != mapped_.end()) return found->second;
  const Owned<drmModeFB2, drmModeFreeFB2> fb(drmModeGetFB2(card_, framebuffer));
  if (!fb) refuse("framebuffer " + std::to_string(framebuffer));
  drm_mode_map_dumb request{.handle = fb->handles[0]};
  if (drmIoctl(card_, DRM_IOCTL_MODE_MAP_DUMB, &request) != 0) refuse("map a framebuffer");
  Mapping mapping{.size = std::size_t{fb->pitches[0]} * fb->height,
                  .width_px = fb->width,
                  .height_px = fb->height,
                  .stride_bytes = fb->pitches[0]};
  void* bytes = ::mmap(nullptr, mapping.size, PROT_READ, MAP_SHARED, card_,
                       static_cast<off_t>(request.offset));
  if (bytes == MAP_FAILED) refuse("map a framebuffer");
  mapping.bytes = static_cast<const std::byte*>(bytes);
  return mapped_.emplace(framebuffer, mapping).first->second;
}

void ScanoutWitness::fetchChecksums() {
  std::array<char, 256> line{};
  for (ssize_t bytes = 0; (bytes = ::read(checksums_fd_, line.data(), line.size() - 1)) > 0;) {
    line[static_cast<std::size_t>(bytes)] = '\0';
    char* rest = nullptr;
    const std::uint64_t vblank = std::strtoull(line.data(), &rest, 16);
    checksums_.push_back(
        {.vblank = vblank, .crc = static_cast<std::uint32_t>(std::strtoul(rest, nullptr, 16))});
  }
  if (checksums_.size() > kKeptChecksums) {
    checksums_.erase(checksums_.begin(), checksums_.end() - kKeptChecksums);
  }
}

std::optional<WitnessedScanout> ScanoutWitness::read(std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  WitnessedScanout out;
  while (std::chrono::steady_clock::now() < end) {
    const std::uint32_t shown = framebuffer();
    if (shown != 0) {
      const Mapping& mapping = map(shown);
      out.width_px = mapping.width_px;
      out.height_px = mapping.height_px;
      out.pixels.resize(std::size_t{out.width_px} * out.height_px);
      for (std::uint32_t row = 0; row < out.height_px; ++row) {
        std::memcpy(&out.pixels[std::size_t{row} * out.width_px],
                    mapping.bytes + std::size_t{row} * mapping.stride_bytes,
                    std::size_t{out.width_px} * sizeof(std::uint32_t));
      }
      for (std::uint32_t& pixel : out.pixels) pixel &= 0xffffff;
      const std::uint32_t crc = vkmsChecksum(out.pixels);
      fetchChecksums();
      const auto sent =
          std::ranges::find(checksums_.rbegin(), checksums_.rend(), crc, &FrameChecksum::crc);
      if (sent != checksums_.rend()) {
        out.vblank = sent->vblank;
        return out;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return std::nullopt;
}

}  // namespace test
