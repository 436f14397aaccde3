#include "ui-kms/kms/output.h"

#include <cerrno>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <xf86drm.h>

#include "ui-kms/kms/framebuffer.h"

namespace ui::kms {
namespace {

using Resources = std::unique_ptr<drmModeRes, decltype(&drmModeFreeResources)>;
using PlaneList = std::unique_ptr<drmModePlaneRes, decltype(&drmModeFreePlaneResources)>;
using Plane = std::unique_ptr<drmModePlane, decltype(&drmModeFreePlane)>;
using Encoder = std::unique_ptr<drmModeEncoder, decltype(&drmModeFreeEncoder)>;

std::vector<std::uint32_t> planesOf(int fd) {
  const PlaneList list(drmModeGetPlaneResources(fd), &drmModeFreePlaneResources);
  return list ? std::vector<std::uint32_t>(list->planes, list->planes + list->count_planes)
              : std::vector<std::uint32_t>{};
}

/// Bit i: the connector can be driven by the card's CRTC i.
std::uint32_t possibleCrtcs(int fd, const Connector& connector) {
  std::uint32_t possible = 0;
  for (const std::uint32_t id : connector.encoders) {
    const Encoder encoder(drmModeGetEncoder(fd, id), &drmModeFreeEncoder);
    if (encoder) possible |= encoder->possible_crtcs;
  }
  return possible;
}

std::optional<std::uint32_t> primaryPlane(int fd, std::uint32_t crtc_bit) {
  for (const std::uint32_t id : planesOf(fd)) {
    const Plane plane(drmModeGetPlane(fd, id), &drmModeFreePlane);
    if (!plane || (plane->possible_crtcs & crtc_bit) == 0) continue;
    const auto type = Properties::read(fd, id, DRM_MODE_OBJECT_PLANE).value("type");
    if (type == DRM_PLANE_TYPE_PRIMARY) return id;
  }
  return std::nullopt;
}

/// A mode as the kernel wants it, for the time of one commit.
class ModeBlob {
 public:
  ModeBlob(int fd, const drmModeModeInfo& mode) : fd_(fd) {
    if (drmModeCreatePropertyBlob(fd, &mode, sizeof mode, &id_) != 0) id_ = 0;
  }
  ~ModeBlob() {
    if (id_ != 0) drmModeDestroyPropertyBlob(fd_, id_);
  }
  ModeBlob(const ModeBlob&) = delete;
  ModeBlob& operator=(const ModeBlob&) = delete;
  [[nodiscard]] std::uint32_t id() const { return id_; }

 private:
  int fd_;
  std::uint32_t id_ = 0;
};

}  // namespace

std::optional<Output> Output::find(int fd, Connector connector) {
  const Resources resources(drmModeGetResources(fd), &drmModeFreeResources);
  Output output(fd, std::move(connector));
  const std::uint32_t possible = possibleCrtcs(fd, output.connector_);
  const std::uint32_t current =
      static_cast<std::uint32_t>(output.connector_.properties.value("CRTC_ID").value_or(0));
  for (int i = 0; resources && i < resources->count_crtcs; ++i) {
    const std::uint32_t bit = 1U << static_cast<unsigned>(i);
    const std::uint32_t crtc = resources->crtcs[i];
    // The one that drives it already is best: no other screen of the card is disturbed.
    if ((possible & bit) == 0 || (output.crtc_ != 0 && crtc != current)) continue;
    const auto plane = primaryPlane(fd, bit);
    if (!plane) continue;
    output.crtc_ = crtc;
    output.plane_ = *plane;
  }
  if (output.crtc_ == 0) {
    return std::nullopt;
  }
  output.crtc_properties_ = Properties::read(fd, output.crtc_, DRM_MODE_OBJECT_CRTC);
  output.plane_properties_ = Properties::read(fd, output.plane_, DRM_MODE_OBJECT_PLANE);
  output.framebuffer_property_ = output.plane_properties_.id("FB_ID");
  output.fence_property_ = output.plane_properties_.id("IN_FENCE_FD");
  return output;
}

/// Takes everything that is not ours off our CRTC: other planes would cover the picture, another
/// connector would not take its mode.
void Output::clear(AtomicRequest& request) const {
  for (const std::uint32_t id : planesOf(fd_)) {
    if (id == plane_) continue;
    const Properties plane = Properties::read(fd_, id, DRM_MODE_OBJECT_PLANE);
    if (plane.value("CRTC_ID") != crtc_) continue;
    request.set(id, plane.id("FB_ID"), 0);
    request.set(id, plane.id("CRTC_ID"), 0);
  }
  const Resources resources(drmModeGetResources(fd_), &drmModeFreeResources);
  for (int i = 0; resources && i < resources->count_connectors; ++i) {
    const std::uint32_t id = resources->connectors[i];
    if (id == connector_.id) continue;
    const Properties other = Properties::read(fd_, id, DRM_MODE_OBJECT_CONNECTOR);
    if (other.value("CRTC_ID") == crtc_) request.set(id, other.id("CRTC_ID"), 0);
  }
}

void Output::addMode(AtomicRequest& request, const drmModeModeInfo& mode,
                     std::uint32_t mode_blob) const {
  const Properties& connector = connector_.properties;
  request.set(connector_.id, connector.id("CRTC_ID"), crtc_);
  request.set(connector_.id, connector.id("link-status"), DRM_MODE_LINK_STATUS_GOOD);
  const Properties& crtc = crtc_properties_;
  request.set(crtc_, crtc.id("MODE_ID"), mode_blob);
  request.set(crtc_, crtc.id("ACTIVE"), 1);
  for (const char* table : {"GAMMA_LUT", "DEGAMMA_LUT", "CTM"}) {
    request.set(crtc_, crtc.id(table), 0);
  }
  request.set(crtc_, crtc.id("VRR_ENABLED"), 0);
  const Properties& plane = plane_properties_;
  request.set(plane_, plane.id("CRTC_ID"), crtc_);
  request.set(plane_, plane.id("SRC_X"), 0);
  request.set(plane_, plane.id("SRC_Y"), 0);
  request.set(plane_, plane.id("SRC_W"), std::uint64_t{mode.hdisplay} << 16);  // 16.16 fixed
  request.set(plane_, plane.id("SRC_H"), std::uint64_t{mode.vdisplay} << 16);
  request.set(plane_, plane.id("CRTC_X"), 0);
  request.set(plane_, plane.id("CRTC_Y"), 0);
  request.set(plane_, plane.id("CRTC_W"), mode.hdisplay);
  request.set(plane_, plane.id("CRTC_H"), mode.vdisplay);
  request.set(plane_, plane.id("rotation"), DRM_MODE_ROTATE_0);
  request.set(plane_, plane.id("alpha"), 0xffff);
}

void Output::addPicture(AtomicRequest& request, std::uint32_t framebuffer, int fence) const {
  request.set(plane_, framebuffer_property_, framebuffer);
  if (fence >= 0) request.set(plane_, fence_property_, static_cast<std::uint64_t>(fence));
}

void Output::addDesirable(AtomicRequest& request) const {
  const Properties& connector = connector_.properties;
  const auto choose = [&](const char* name, const char* choice) {
    if (const auto value = connector.choice(name, choice)) {
      request.set(connector_.id, connector.id(name), *value);
    }
  };
  choose("content type", "Game");        // screens leave out what costs them time
  choose("Broadcast RGB", "Automatic");  // what HDMI says for this mode, which screens expect
  choose("underscan", "off");
  // Our pictures have eight bits; more would only take the link's bandwidth from the mode.
  if (const auto bits = connector.inRange("max bpc", 8)) {
    request.set(connector_.id, connector.id("max bpc"), *bits);
  }
}

/// The first of two requests that the driver would carry out: with the optional properties, or
/// without.
std::expected<AtomicRequest, int> Output::lightingRequest(const drmModeModeInfo& mode,
                                                          std::uint32_t mode_blob,
                                                          std::uint32_t framebuffer,
                                                          int fence) const {
  int refused = EINVAL;
  for (const bool desirable : {true, false}) {
    AtomicRequest request;
    clear(request);
    addMode(request, mode, mode_blob);
    addPicture(request, framebuffer, fence);
    if (desirable) addDesirable(request);
    const auto tested = request.test(fd_, /*modeset=*/true);
    if (tested) return request;
    refused = tested.error();
    if (refused != EINVAL && refused != ERANGE) break;
  }
  return std::unexpected(refused);
}

AtomicRequest::Outcome Output::tryLight(const drmModeModeInfo& mode) const {
  const auto memory = DumbBuffer::create(fd_, mode.hdisplay, mode.vdisplay);
  if (!memory) return std::unexpected(memory.error());
  const auto framebuffer = Framebuffer::create(fd_, memory->layout());
  if (!framebuffer) return std::unexpected(framebuffer.error());
  const ModeBlob blob(fd_, mode);
  const auto request = lightingRequest(mode, blob.id(), framebuffer->id(), -1);
  if (!request) return std::unexpected(request.error());
  return {};
}

AtomicRequest::Outcome Output::light(const drmModeModeInfo& mode, std::uint32_t framebuffer,
                                     int fence, std::uint64_t serial) const {
  const ModeBlob blob(fd_, mode);
  const auto request = lightingRequest(mode, blob.id(), framebuffer, fence);
  if (!request) return std::unexpected(request.error());
  return request->submit(fd_, /*modeset=*/true, serial);
}

AtomicRequest::Outcome Output::flip(std::uint32_t framebuffer, int fence,
                                    std::uint64_t serial) const {
  AtomicRequest request;
  addPicture(request, framebuffer, fence);
  return request.submit(fd_, /*modeset=*/false, serial);
}

AtomicRequest::Outcome Output::darken() const {
  AtomicRequest request;
  clear(request);
  request.set(plane_, framebuffer_property_, 0);
  request.set(plane_, plane_properties_.id("CRTC_ID"), 0);
  request.set(connector_.id, connector_.properties.id("CRTC_ID"), 0);
  request.set(crtc_, crtc_properties_.id("ACTIVE"), 0);
  request.set(crtc_, crtc_properties_.id("MODE_ID"), 0);
  return request.carryOut(fd_, /*modeset=*/true);
}

std::optional<Vblank> Output::lastVblank() const {
  std::uint64_t number = 0;
  std::uint64_t at_ns = 0;
  if (drmCrtcGetSequence(fd_, crtc_, &number, &at_ns) != 0) return std::nullopt;
  return Vblank{.number = number, .at = rt::fromNs(static_cast<std::int64_t>(at_ns))};
}

}  // namespace ui::kms
