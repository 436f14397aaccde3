#pragma once

#include <systemd/sd-bus.h>

#include "appliance/control/status_properties.h"

namespace appliance {

/// Appends @p value with the signature typeOf() says. Texts that are not UTF-8 are made so, because
/// one of them would make the whole message impossible.
/// Returns a negative errno of sd-bus if there is no memory.
[[nodiscard]] int appendValue(sd_bus_message* message, const BusValue& value);

}  // namespace appliance
