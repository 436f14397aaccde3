#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include <xf86drmMode.h>

#include "rt/clock.h"
#include "ui-kms/kms/atomic_request.h"
#include "ui-kms/kms/connector.h"
#include "ui-kms/kms/properties.h"

namespace ui::kms {

struct Vblank {
  std::uint64_t number;
  rt::Timestamp at;
};

/// The way of a picture inside the card: the primary plane fetches it from memory, the CRTC times
/// it, the connector sends it to the screen. Only the connector is given by where the cable is; the
/// other two are chosen here.
///
/// Threads  One. The device's descriptor outlives it.
class Output {
 public:
  /// None if the card has no free CRTC with a plane for the connector.
  [[nodiscard]] static std::optional<Output> find(int fd, Connector connector);

  [[nodiscard]] const Connector& connector() const { return connector_; }

  /// Whether the driver would set @p mode, at least without the optional properties. Changes
  /// nothing.
  [[nodiscard]] AtomicRequest::Outcome tryLight(const drmModeModeInfo& mode) const;

  /// Sets @p mode and shows @p framebuffer, which has that mode's size; otherwise as flip().
  /// Tested first. Optional properties (content type, colour range, underscan) are left out if the
  /// driver refuses the whole with them. Resets what another program left behind.
  [[nodiscard]] AtomicRequest::Outcome light(const drmModeModeInfo& mode, std::uint32_t framebuffer,
                                             int fence, std::uint64_t serial) const;

  /// Shows @p framebuffer from the next vblank on. @p fence: signals when its pixels are written;
  /// -1: they are. Never changes the mode.
  [[nodiscard]] AtomicRequest::Outcome flip(std::uint32_t framebuffer, int fence,
                                            std::uint64_t serial) const;

  /// Switches the screen off, so that the next light() trains its link again. Waits for it.
  [[nodiscard]] AtomicRequest::Outcome darken() const;

  /// The last vblank. None: the driver reports none; flips then happen immediately, without a
  /// number.
  [[nodiscard]] std::optional<Vblank> lastVblank() const;
  [[nodiscard]] bool takesFences() const { return fence_property_ != 0; }

 private:
  Output(int fd, Connector connector) : fd_(fd), connector_(std::move(connector)) {}
  void clear(AtomicRequest& request) const;
  void addMode(AtomicRequest& request, const drmModeModeInfo& mode, std::uint32_t mode_blob) const;
  void addPicture(AtomicRequest& request, std::uint32_t framebuffer, int fence) const;
  void addDesirable(AtomicRequest& request) const;
  [[nodiscard]] std::expected<AtomicRequest, int> lightingRequest(const drmModeModeInfo& mode,
                                                                  std::uint32_t mode_blob,
                                                                  std::uint32_t framebuffer,
                                                                  int fence) const;

  int fd_;
  Connector connector_;
  std::uint32_t crtc_ = 0;
  Properties crtc_properties_;
  std::uint32_t plane_ = 0;
  Properties plane_properties_;
  std::uint32_t framebuffer_property_ = 0;  // looked up once: it is every flip's
  std::uint32_t fence_property_ = 0;
};

}  // namespace ui::kms
