#include "hal/aravis/resend.h"

#include <algorithm>

namespace hal::aravis {

const ResendPolicy& resendPolicyFor(const CameraProfile& profile, std::string_view model) {
  const auto own = std::ranges::find(profile.resend_by_model, model, &ModelResendPolicy::model);
  return own != profile.resend_by_model.end() ? own->policy : profile.resend;
}

void applyResend(ArvStream* stream, const ResendPolicy& policy) {
  g_object_set(
      stream,  //
      "packet-resend",
      policy.enabled ? ARV_GV_STREAM_PACKET_RESEND_ALWAYS : ARV_GV_STREAM_PACKET_RESEND_NEVER,
      "packet-timeout", static_cast<guint>(policy.packet_timeout_us),                  //
      "initial-packet-timeout", static_cast<guint>(policy.initial_packet_timeout_us),  //
      "frame-retention", static_cast<guint>(policy.frame_retention_us),                //
      "packet-request-ratio", policy.request_ratio, nullptr);
}

}  // namespace hal::aravis
