#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ui::kms {

/// A KMS object is a number with named properties; everything that atomic mode setting does is to
/// give some of them other values. Names are looked up once: this is the table of one object.
///
/// Threads  Any one at a time.
class Properties {
 public:
  Properties() = default;
  /// @p type: DRM_MODE_OBJECT_CONNECTOR and so on. An object that vanished has no properties.
  [[nodiscard]] static Properties read(int fd, std::uint32_t object, std::uint32_t type);

  /// 0: not offered.
  [[nodiscard]] std::uint32_t id(std::string_view name) const;
  /// When it was read.
  [[nodiscard]] std::optional<std::uint64_t> value(std::string_view name) const;
  /// The number of one choice of an enumerated property, "Game" of "content type" say.
  [[nodiscard]] std::optional<std::uint64_t> choice(std::string_view name,
                                                    std::string_view choice) const;
  /// @p wanted within the bounds of a ranged property.
  [[nodiscard]] std::optional<std::uint64_t> inRange(std::string_view name,
                                                     std::uint64_t wanted) const;

 private:
  struct Property {
    std::string name;
    std::uint32_t id = 0;
    std::uint64_t value = 0;
    std::vector<std::pair<std::string, std::uint64_t>> choices;
    std::optional<std::pair<std::uint64_t, std::uint64_t>> range;
  };
  [[nodiscard]] const Property* find(std::string_view name) const;

  std::vector<Property> properties_;
};

}  // namespace ui::kms
