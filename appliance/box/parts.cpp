#include "appliance/box/parts.h"

#include "appliance/capture/cameras_part.h"
#include "appliance/capture/trigger_part.h"
#include "appliance/depth/depth_part.h"
#include "appliance/machine/machine_part.h"
#include "appliance/overlay/overlay_part.h"
#include "appliance/panel/panel_part.h"
#include "appliance/render/render_part.h"

namespace appliance {

std::span<const PartEntry> productParts() {
  // The one place that names them. They stop in reverse order. Cameras wait for their trigger: the
  // first edge comes last, and the first thing to end are the edges.
  static constexpr PartEntry kParts[] = {
      {makeMachinePart},  // sees what the machine does while the others start
      {makeRenderPart, kRenderPins},
      {makeOverlayPart},
      {makePanelPart},
      {makeDepthPart},
      {makeCamerasPart},
      {makeTriggerPart},
  };
  return kParts;
}

}  // namespace appliance
