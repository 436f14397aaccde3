#pragma once

#include "appliance/box/shared.h"
#include "appliance/status/status.h"
#include "appliance/trace/records.h"

namespace appliance {

/// Adds what the box itself says: its version, and the commands that were refused.
void addBoxSections(Status& status, const CommandInbox& commands);

/// Adds a remark if @p trace is not written any more; none: not traced.
void remarkTrace(Status& status, const TraceWriter* trace);

/// The first record of a trace: what runs, as soon as every thread does.
[[nodiscard]] RunRecord runRecord(const Shared& shared, const Status& status);

/// The last one, of a box that has stopped.
[[nodiscard]] SummaryRecord summaryRecord(const Status& status);

}  // namespace appliance
