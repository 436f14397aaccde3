#pragma once

#include "appliance/box/part.h"
#include "tests/unit/sample_part/sample_settings.h"

namespace appliance {

/// The smallest part that has everything: settings, a thread, a section, a remark, a request, an
/// object on the bus, a job. It counts the turns of its thread.
///
/// Requests  sample.reset: counts from 0 again.
/// Bus       /org/kagami/Kagami1/sample: property Turns, method Reset; method Count starts a job
/// that ends
///           after so many more turns.
[[nodiscard]] MadePart makeSamplePart(const Shared& shared, const SampleSettings& settings);

}  // namespace appliance
