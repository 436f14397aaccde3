#pragma once

#include "appliance/box/shared.h"
#include "appliance/status/status.h"
#include "appliance/trace/records.h"

namespace appliance {

/// The first record of a trace: what runs, as soon as every thread does.
[[nodiscard]] RunRecord runRecord(const Shared& shared, const Status& status);

/// The last one, of a box that has stopped.
[[nodiscard]] SummaryRecord summaryRecord(const Status& status);

}  // namespace appliance
