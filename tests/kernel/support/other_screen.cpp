#include "tests/kernel/support/other_screen.h"

#include <algorithm>
#include <cerrno>
#include <span>
#include <string_view>

#include <dlfcn.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

// libdrm's functions, found before libdrm's own because they are the program's.

namespace {

std::uint32_t only_width_px = 0;
std::uint32_t only_height_px = 0;
bool link_broken = false;
bool atomic_refused = false;
int modes_to_refuse = 0;

template <class Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

namespace test {

void OtherScreen::offerOnly(std::uint32_t width_px, std::uint32_t height_px) {
  only_width_px = width_px;
  only_height_px = height_px;
}
void OtherScreen::breakLink() {
  link_broken = true;
}
void OtherScreen::refuseAtomic(bool refuse) {
  atomic_refused = refuse;
}
void OtherScreen::refuseModes(int commits) {
  modes_to_refuse = commits;
}

}  // namespace test

extern "C" {

drmModeConnectorPtr drmModeGetConnector(int fd, std::uint32_t id) {
  static auto* const real = original<decltype(drmModeGetConnector)>("drmModeGetConnector");
  drmModeConnectorPtr connector = real(fd, id);
  if (connector == nullptr || only_width_px == 0) return connector;
  const std::span modes(connector->modes, static_cast<std::size_t>(connector->count_modes));
  const auto rest = std::ranges::remove_if(modes, [](const drmModeModeInfo& mode) {
    return mode.hdisplay != only_width_px || mode.vdisplay != only_height_px;
  });
  connector->count_modes -= static_cast<int>(rest.size());
  return connector;
}

drmModeObjectPropertiesPtr drmModeObjectGetProperties(int fd, std::uint32_t object,
                                                      std::uint32_t type) {
  static auto* const real =
      original<decltype(drmModeObjectGetProperties)>("drmModeObjectGetProperties");
  drmModeObjectPropertiesPtr properties = real(fd, object, type);
  if (properties == nullptr || !link_broken) return properties;
  for (std::uint32_t i = 0; i < properties->count_props; ++i) {
    drmModePropertyPtr property = drmModeGetProperty(fd, properties->props[i]);
    if (property == nullptr) continue;
    if (std::string_view(property->name) == "link-status") {
      properties->prop_values[i] = DRM_MODE_LINK_STATUS_BAD;
    }
    drmModeFreeProperty(property);
  }
  return properties;
}

int drmSetClientCap(int fd, std::uint64_t capability, std::uint64_t value) {
  static auto* const real = original<decltype(drmSetClientCap)>("drmSetClientCap");
  if (atomic_refused && capability == DRM_CLIENT_CAP_ATOMIC) {
    errno = EOPNOTSUPP;
    return -1;
  }
  return real(fd, capability, value);
}

int drmModeAtomicCommit(int fd, drmModeAtomicReqPtr request, std::uint32_t flags, void* user_data) {
  static auto* const real = original<decltype(drmModeAtomicCommit)>("drmModeAtomicCommit");
  const bool sets_mode = (flags & DRM_MODE_ATOMIC_ALLOW_MODESET) != 0;
  if (sets_mode && modes_to_refuse > 0) {
    --modes_to_refuse;
    errno = EINVAL;
    return -1;
  }
  if (sets_mode && (flags & DRM_MODE_ATOMIC_TEST_ONLY) == 0) link_broken = false;
  return real(fd, request, flags, user_data);
}

}  // extern "C"
