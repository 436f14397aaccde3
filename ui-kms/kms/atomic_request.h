#pragma once

#include <cstdint>
#include <expected>
#include <memory>

#include <xf86drmMode.h>

namespace ui::kms {

/// A change of several properties that happens as a whole at one vblank, or not at all.
///
/// Errors   The errno of the kernel: EINVAL the driver cannot do this, EBUSY the last change has
///          not happened yet, EACCES we are not master.
class AtomicRequest {
 public:
  using Outcome = std::expected<void, int>;

  AtomicRequest() : request_(drmModeAtomicAlloc()) {}

  /// Property 0, one that the driver does not offer, is left out.
  void set(std::uint32_t object, std::uint32_t property, std::uint64_t value);

  /// Would the driver do it? Changes nothing. @p modeset: the screen may go dark for it.
  [[nodiscard]] Outcome test(int fd, bool modeset) const;
  /// Returns immediately; a flip event that carries @p serial comes when it has happened.
  [[nodiscard]] Outcome submit(int fd, bool modeset, std::uint64_t serial) const;
  /// Returns when it has happened.
  [[nodiscard]] Outcome carryOut(int fd, bool modeset) const;

 private:
  [[nodiscard]] Outcome commit(int fd, std::uint32_t flags, std::uint64_t serial) const;

  struct Free {
    void operator()(drmModeAtomicReq* request) const { drmModeAtomicFree(request); }
  };
  std::unique_ptr<drmModeAtomicReq, Free> request_;
};

}  // namespace ui::kms
