#pragma once

#include <string_view>

#include <arv.h>

#include "hal/camera_profile.h"

namespace hal::aravis {

/// What @p profile says for cameras that call themselves @p model.
[[nodiscard]] const ResendPolicy& resendPolicyFor(const CameraProfile& profile,
                                                  std::string_view model);

/// Puts the policy into force; before the first frame.
///
/// Aravis counts its wait for packets in whole milliseconds and, below one, does not wait at all.
void applyResend(ArvStream* stream, const ResendPolicy& policy);

}  // namespace hal::aravis
