// Loaded into a program before libdrm: while the file $PULLED_CABLE exists its screens are
// unplugged. For the kernel with virtual time, whose VKMS cannot unplug any.

#include <cstdint>
#include <cstdlib>

#include <dlfcn.h>
#include <unistd.h>
#include <xf86drmMode.h>

namespace {

drmModeConnectorPtr answer(const char* function, int fd, std::uint32_t id) {
  using Read = drmModeConnectorPtr(int, std::uint32_t);
  drmModeConnectorPtr connector = reinterpret_cast<Read*>(::dlsym(RTLD_NEXT, function))(fd, id);
  const char* file = std::getenv("PULLED_CABLE");
  if (connector != nullptr && file != nullptr && ::access(file, F_OK) == 0) {
    connector->connection = DRM_MODE_DISCONNECTED;
  }
  return connector;
}

}  // namespace

extern "C" {
drmModeConnectorPtr drmModeGetConnector(int fd, std::uint32_t id) {
  return answer("drmModeGetConnector", fd, id);
}
drmModeConnectorPtr drmModeGetConnectorCurrent(int fd, std::uint32_t id) {
  return answer("drmModeGetConnectorCurrent", fd, id);
}
}
