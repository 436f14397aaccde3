#include "tests/kernel/support/scanout_reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "ui-kms/kms/atomic_request.h"
#include "ui-kms/kms/framebuffer.h"
#include "ui-kms/kms/properties.h"

namespace test {
namespace {

using ui::kms::AtomicRequest;
using ui::kms::Properties;
using Resources = std::unique_ptr<drmModeRes, decltype(&drmModeFreeResources)>;

constexpr int kPatienceMs = 10'000;

[[noreturn]] void fail(const std::string& what, int error) {
  throw std::runtime_error("scanout reader: " + what + ": " + std::strerror(error));
}

int pidfdOpen(pid_t pid) {
  return static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
}
int pidfdGetfd(int pidfd, int number) {
  return static_cast<int>(::syscall(SYS_pidfd_getfd, pidfd, number, 0));
}

/// The descriptor of @p pid that is master of @p card.
rt::UniqueFd copyDescriptor(pid_t pid, const std::string& card) {
  const rt::UniqueFd process(pidfdOpen(pid));
  if (!process.valid()) fail("process " + std::to_string(pid), errno);
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    std::error_code error;
    if (std::filesystem::read_symlink(entry.path(), error) != card) continue;
    rt::UniqueFd fd(pidfdGetfd(process.get(), std::stoi(entry.path().filename())));
    if (fd.valid() && drmIsMaster(fd.get()) != 0) return fd;
  }
  fail("process " + std::to_string(pid) + " is not master of " + card, ENOENT);
}

Resources resourcesOf(int fd) {
  return {drmModeGetResources(fd), &drmModeFreeResources};
}

std::uint32_t writebackConnector(int fd) {
  const Resources resources = resourcesOf(fd);
  for (int i = 0; resources && i < resources->count_connectors; ++i) {
    const std::uint32_t id = resources->connectors[i];
    if (Properties::read(fd, id, DRM_MODE_OBJECT_CONNECTOR).id("WRITEBACK_FB_ID") != 0) return id;
  }
  fail("no writeback connector", ENODEV);
}

struct Lit {
  std::uint32_t crtc;
  std::uint32_t width_px;
  std::uint32_t height_px;
};

Lit litCrtc(int fd) {
  const Resources resources = resourcesOf(fd);
  for (int i = 0; resources && i < resources->count_crtcs; ++i) {
    const std::unique_ptr<drmModeCrtc, decltype(&drmModeFreeCrtc)> crtc(
        drmModeGetCrtc(fd, resources->crtcs[i]), &drmModeFreeCrtc);
    if (crtc && crtc->mode_valid != 0) return {crtc->crtc_id, crtc->width, crtc->height};
  }
  fail("no screen is lit", ENOENT);
}

ScannedOut pixelsOf(const ui::kms::DumbBuffer& buffer) {
  const ui::kms::FramebufferLayout layout = buffer.layout();
  ScannedOut picture{.width_px = layout.width_px, .height_px = layout.height_px, .rgba = {}};
  picture.rgba.resize(std::size_t{4} * layout.width_px * layout.height_px);
  auto* to = picture.rgba.data();
  for (std::uint32_t y = 0; y < layout.height_px; ++y) {
    const std::byte* from = &buffer.bytes()[std::size_t{y} * buffer.pitch()];
    for (std::uint32_t x = 0; x < layout.width_px; ++x, from += 4, to += 4) {
      to[0] = from[2];  // XRGB8888 is blue, green, red in memory
      to[1] = from[1];
      to[2] = from[0];
      to[3] = std::byte{255};
    }
  }
  return picture;
}

}  // namespace

std::size_t differingPixels(const ScannedOut& a, const ScannedOut& b) {
  if (a.width_px != b.width_px || a.height_px != b.height_px || a.rgba.size() != b.rgba.size()) {
    return std::max(a.rgba.size(), b.rgba.size()) / 4;
  }
  std::size_t differ = 0;
  for (std::size_t i = 0; i + 3 < a.rgba.size(); i += 4) {
    if (std::memcmp(&a.rgba[i], &b.rgba[i], 3) != 0) ++differ;
  }
  return differ;
}

ScanoutReader::ScanoutReader(pid_t pid, const std::string& card) : fd_(copyDescriptor(pid, card)) {
  if (drmSetClientCap(fd_.get(), DRM_CLIENT_CAP_WRITEBACK_CONNECTORS, 1) != 0) {
    fail("no writeback", errno);
  }
  connector_ = writebackConnector(fd_.get());
}

ScanoutReader::~ScanoutReader() {
  detach();
}

void ScanoutReader::detach() {
  const Properties connector = Properties::read(fd_.get(), connector_, DRM_MODE_OBJECT_CONNECTOR);
  if (connector.value("CRTC_ID").value_or(0) == 0) return;
  AtomicRequest request;
  request.set(connector_, connector.id("CRTC_ID"), 0);
  static_cast<void>(request.carryOut(fd_.get(), /*modeset=*/true));
}

ScannedOut ScanoutReader::read() {
  const Lit lit = litCrtc(fd_.get());
  auto memory = ui::kms::DumbBuffer::create(fd_.get(), lit.width_px, lit.height_px);
  if (!memory) fail("memory to read into", memory.error());
  const auto framebuffer = ui::kms::Framebuffer::create(fd_.get(), memory->layout());
  if (!framebuffer) fail("framebuffer to read into", framebuffer.error());

  const Properties connector = Properties::read(fd_.get(), connector_, DRM_MODE_OBJECT_CONNECTOR);
  std::int32_t written = -1;  // a fence
  AtomicRequest request;
  request.set(connector_, connector.id("CRTC_ID"), lit.crtc);
  request.set(connector_, connector.id("WRITEBACK_FB_ID"), framebuffer->id());
  request.set(connector_, connector.id("WRITEBACK_OUT_FENCE_PTR"),
              reinterpret_cast<std::uintptr_t>(&written));
  if (const auto done = request.carryOut(fd_.get(), /*modeset=*/true); !done) {
    fail("writeback", done.error());
  }
  const rt::UniqueFd fence(written);
  pollfd ready{.fd = fence.get(), .events = POLLIN, .revents = 0};
  if (::poll(&ready, 1, kPatienceMs) <= 0) fail("the picture did not come", ETIMEDOUT);
  return pixelsOf(*memory);
}

}  // namespace test
