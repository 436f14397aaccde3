#pragma once

#include <vector>

#include "appliance/journal/condition_log.h"
#include "appliance/status/status.h"

/// What of a status is worth a line of the journal: pure.
namespace appliance {

/// Cameras in trouble, what is less than configured, the screen and the lock of the triggers.
[[nodiscard]] std::vector<Condition> conditionsOf(const Status& status);

}  // namespace appliance
