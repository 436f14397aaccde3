#include "ui-kms/kms/properties.h"

#include <algorithm>
#include <memory>
#include <span>

#include <xf86drmMode.h>

namespace ui::kms {

Properties Properties::read(int fd, std::uint32_t object, std::uint32_t type) {
  Properties table;
  const std::unique_ptr<drmModeObjectProperties, decltype(&drmModeFreeObjectProperties)> listed(
      drmModeObjectGetProperties(fd, object, type), &drmModeFreeObjectProperties);
  if (!listed) return table;
  for (std::uint32_t i = 0; i < listed->count_props; ++i) {
    const std::unique_ptr<drmModePropertyRes, decltype(&drmModeFreeProperty)> info(
        drmModeGetProperty(fd, listed->props[i]), &drmModeFreeProperty);
    if (!info) continue;
    Property property{.name = info->name,
                      .id = info->prop_id,
                      .value = listed->prop_values[i],
                      .choices = {},
                      .range = {}};
    if ((info->flags & DRM_MODE_PROP_ENUM) != 0) {
      for (const auto& choice :
           std::span(info->enums, static_cast<std::size_t>(std::max(info->count_enums, 0)))) {
        property.choices.emplace_back(choice.name, choice.value);
      }
    }
    if ((info->flags & DRM_MODE_PROP_RANGE) != 0 && info->count_values == 2) {
      property.range = {info->values[0], info->values[1]};
    }
    table.properties_.push_back(std::move(property));
  }
  return table;
}

const Properties::Property* Properties::find(std::string_view name) const {
  const auto found = std::ranges::find(properties_, name, &Property::name);
  return found == properties_.end() ? nullptr : &*found;
}

std::uint32_t Properties::id(std::string_view name) const {
  const Property* property = find(name);
  return property == nullptr ? 0 : property->id;
}

std::optional<std::uint64_t> Properties::value(std::string_view name) const {
  const Property* property = find(name);
  if (property == nullptr) return std::nullopt;
  return property->value;
}

std::optional<std::uint64_t> Properties::choice(std::string_view name,
                                                std::string_view choice) const {
  const Property* property = find(name);
  if (property == nullptr) return std::nullopt;
  for (const auto& [choice_name, value] : property->choices) {
    if (choice_name == choice) return value;
  }
  return std::nullopt;
}

std::optional<std::uint64_t> Properties::inRange(std::string_view name,
                                                 std::uint64_t wanted) const {
  const Property* property = find(name);
  if (property == nullptr || !property->range) return std::nullopt;
  return std::clamp(wanted, property->range->first, property->range->second);
}

}  // namespace ui::kms
