#include "appliance/control/bus_values.h"

#include "rt/printable.h"

namespace appliance {
namespace {

constexpr std::size_t kLongestText = 100'000;

int append(sd_bus_message* message, std::uint32_t number) {
  return sd_bus_message_append(message, "u", number);
}

int append(sd_bus_message* message, std::uint64_t number) {
  return sd_bus_message_append(message, "t", number);
}

int append(sd_bus_message* message, double number) {
  return sd_bus_message_append(message, "d", number);
}

int append(sd_bus_message* message, const std::string& text) {
  return sd_bus_message_append(message, "s", rt::printable(text, kLongestText).c_str());
}

int append(sd_bus_message* message, const std::array<double, 3>& point) {
  return sd_bus_message_append(message, "(ddd)", point[0], point[1], point[2]);
}

int append(sd_bus_message* message, const std::vector<std::string>& lines) {
  if (const int r = sd_bus_message_open_container(message, 'a', "s"); r < 0) return r;
  for (const std::string& line : lines)
    if (const int r = append(message, line); r < 0) return r;
  return sd_bus_message_close_container(message);
}

int appendEntry(sd_bus_message* message, const std::string& name, const BusScalar& value) {
  if (const int r = sd_bus_message_open_container(message, 'e', "sv"); r < 0) return r;
  if (const int r = append(message, name); r < 0) return r;
  const char* type = std::holds_alternative<std::string>(value) ? "s" : "t";
  if (const int r = sd_bus_message_open_container(message, 'v', type); r < 0) return r;
  const auto append_it = [message](const auto& scalar) { return append(message, scalar); };
  if (const int r = std::visit(append_it, value); r < 0) return r;
  if (const int r = sd_bus_message_close_container(message); r < 0) return r;
  return sd_bus_message_close_container(message);
}

int append(sd_bus_message* message, const std::vector<BusDictionary>& table) {
  if (const int r = sd_bus_message_open_container(message, 'a', "a{sv}"); r < 0) return r;
  for (const BusDictionary& row : table) {
    if (const int r = sd_bus_message_open_container(message, 'a', "{sv}"); r < 0) return r;
    for (const auto& [name, value] : row)
      if (const int r = appendEntry(message, name, value); r < 0) return r;
    if (const int r = sd_bus_message_close_container(message); r < 0) return r;
  }
  return sd_bus_message_close_container(message);
}

}  // namespace

int appendValue(sd_bus_message* message, const BusValue& value) {
  return std::visit([message](const auto& held) { return append(message, held); }, value);
}

}  // namespace appliance
