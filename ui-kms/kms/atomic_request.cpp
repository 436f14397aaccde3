#include "ui-kms/kms/atomic_request.h"

#include <cerrno>

namespace ui::kms {
namespace {

constexpr std::uint32_t modesetFlag(bool modeset) {
  return modeset ? DRM_MODE_ATOMIC_ALLOW_MODESET : 0;
}

}  // namespace

void AtomicRequest::set(std::uint32_t object, std::uint32_t property, std::uint64_t value) {
  if (property == 0) return;
  // Without memory the change would be half a change: the commit finds no request then.
  if (drmModeAtomicAddProperty(request_.get(), object, property, value) < 0) request_.reset();
}

AtomicRequest::Outcome AtomicRequest::test(int fd, bool modeset) const {
  return commit(fd, DRM_MODE_ATOMIC_TEST_ONLY | modesetFlag(modeset), 0);
}

AtomicRequest::Outcome AtomicRequest::submit(int fd, bool modeset, std::uint64_t serial) const {
  return commit(fd, DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT | modesetFlag(modeset),
                serial);
}

AtomicRequest::Outcome AtomicRequest::carryOut(int fd, bool modeset) const {
  return commit(fd, modesetFlag(modeset), 0);
}

AtomicRequest::Outcome AtomicRequest::commit(int fd, std::uint32_t flags,
                                             std::uint64_t serial) const {
  if (!request_) return std::unexpected(ENOMEM);
  // The kernel hands the pointer back with the flip event: a number serves us better.
  void* cookie = reinterpret_cast<void*>(static_cast<std::uintptr_t>(serial));
  if (drmModeAtomicCommit(fd, request_.get(), flags, cookie) != 0) {
    return std::unexpected(errno);
  }
  return {};
}

}  // namespace ui::kms
