// The witness of the true scanout, against pictures that no code of ours put on the screen.

#include "tests/kernel/support/scanout_witness.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kWidth = 640;
constexpr std::uint32_t kHeight = 480;

std::uint32_t pixelOf(std::uint32_t picture, std::uint32_t x, std::uint32_t y) {
  return (x * 255 / kWidth) << 16 | (y * 255 / kHeight) << 8 | (picture * 37 & 255);
}

/// Shows pictures by the kernel's oldest interface.
class PlainScreen {
 public:
  PlainScreen() : card_(::open("/dev/dri/card0", O_RDWR | O_CLOEXEC)) {
    drmModeRes* resources = drmModeGetResources(card_);
    crtc_ = resources->crtcs[0];
    for (int i = 0; i < resources->count_connectors && connector_ == 0; ++i) {
      drmModeConnector* connector = drmModeGetConnector(card_, resources->connectors[i]);
      for (int m = 0; m < connector->count_modes; ++m) {
        const drmModeModeInfo& mode = connector->modes[m];
        if (mode.hdisplay != kWidth || mode.vdisplay != kHeight) continue;
        connector_ = connector->connector_id;
        mode_ = mode;
      }
      drmModeFreeConnector(connector);
    }
    drmModeFreeResources(resources);
  }
  ~PlainScreen() { ::close(card_); }
  PlainScreen(const PlainScreen&) = delete;
  PlainScreen& operator=(const PlainScreen&) = delete;

  void show(std::uint32_t picture) {
    drm_mode_create_dumb made{.height = kHeight, .width = kWidth, .bpp = 32};
    ASSERT_EQ(drmIoctl(card_, DRM_IOCTL_MODE_CREATE_DUMB, &made), 0);
    drm_mode_map_dumb map{.handle = made.handle};
    ASSERT_EQ(drmIoctl(card_, DRM_IOCTL_MODE_MAP_DUMB, &map), 0);
    void* bytes = ::mmap(nullptr, made.size, PROT_READ | PROT_WRITE, MAP_SHARED, card_,
                         static_cast<off_t>(map.offset));
    ASSERT_NE(bytes, MAP_FAILED);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      auto* row = reinterpret_cast<std::uint32_t*>(static_cast<char*>(bytes) + y * made.pitch);
      for (std::uint32_t x = 0; x < kWidth; ++x) row[x] = pixelOf(picture, x, y);
    }
    ::munmap(bytes, made.size);
    std::uint32_t framebuffer = 0;
    ASSERT_EQ(drmModeAddFB(card_, kWidth, kHeight, 24, 32, made.pitch, made.handle, &framebuffer),
              0);
    ASSERT_EQ(drmModeSetCrtc(card_, crtc_, framebuffer, 0, 0, &connector_, 1, &mode_), 0)
        << std::strerror(errno);
  }

 private:
  int card_;
  std::uint32_t crtc_ = 0;
  std::uint32_t connector_ = 0;
  drmModeModeInfo mode_{};
};

TEST(ScanoutWitness, ReadsWhatAnotherProgramShows) {
  PlainScreen screen;
  std::uint64_t before = 0;
  for (const std::uint32_t picture : {1U, 2U, 3U}) {
    ASSERT_NO_FATAL_FAILURE(screen.show(picture));
    test::ScanoutWitness witness;
    const auto read = witness.read(5s);
    ASSERT_TRUE(read) << "picture " << picture;
    ASSERT_EQ(read->width_px, kWidth);
    ASSERT_EQ(read->height_px, kHeight);
    std::size_t differing = 0;
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        if (read->pixels[std::size_t{y} * kWidth + x] != pixelOf(picture, x, y)) ++differing;
      }
    }
    EXPECT_EQ(differing, 0U);
    EXPECT_GT(read->vblank, before);
    before = read->vblank;
  }
}

TEST(VkmsChecksum, ChangesWithOneBitOfOnePixel) {
  std::vector<std::uint32_t> pixels(1000, 0x123456);
  const std::uint32_t before = test::vkmsChecksum(pixels);
  pixels[999] ^= 1;
  EXPECT_NE(test::vkmsChecksum(pixels), before);
}

}  // namespace
