#include "hal/gpiod/line_finder.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <system_error>

#include <gpiod.hpp>

#include "hal/gpiod/expander.h"
#include "rt/edit_distance.h"

namespace hal::gpiod {
namespace {

constexpr std::size_t kNearestNamed = 3;

std::string quoted(const std::string& name) {
  return '"' + name + '"';
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all.append(all.empty() ? "" : ", ").append(part);
  return all;
}

std::string nearestNames(const LineList& list, const std::string& name) {
  std::vector<std::string> names;
  for (const ListedLine& line : list.lines) names.push_back(line.name);
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::ranges::stable_sort(names, {}, [&](const auto& one) { return rt::editDistance(one, name); });
  names.resize(std::min(names.size(), kNearestNamed));
  std::ranges::transform(names, names.begin(), quoted);
  return joined(names);
}

std::string notFound(const LineList& list, const std::string& name, const std::string& key) {
  std::string text = key + ": no GPIO line is named " + quoted(name);
  if (!list.lines.empty()) {
    text += "; the nearest names are " + nearestNames(list, name);
  } else if (list.refused.empty()) {
    return text + ": this machine shows no named line: check the board's driver and device tree";
  }
  if (!list.refused.empty())
    return text + "; not looked at: " + joined(list.refused) + ": put the user into the group gpio";
  return text + ": gpioinfo lists all";
}

void appendLines(const std::filesystem::path& device, const std::filesystem::path& sysfs,
                 std::vector<ListedLine>& lines) {
  const ::gpiod::chip chip(device);
  const ::gpiod::chip_info about = chip.get_info();
  const std::string bus = expanderBus(sysfs, about.name()).value_or("");
  for (unsigned offset = 0; offset < about.num_lines(); ++offset) {
    const ::gpiod::line_info line = chip.get_line_info(offset);
    if (line.name().empty()) continue;
    std::string consumer = line.used() ? line.consumer() : "";
    if (line.used() && consumer.empty()) consumer = "the kernel";
    lines.push_back({.name = line.name(),
                     .chip = about.name(),
                     .chip_label = about.label(),
                     .offset = offset,
                     .consumer = std::move(consumer),
                     .bus = bus});
  }
}

}  // namespace

LineList listLines(const std::filesystem::path& sysfs) {
  std::vector<std::filesystem::path> devices;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", absent)) {
    const std::filesystem::path& path = entry.path();
    if (path.filename().string().starts_with("gpiochip") && !entry.is_symlink(absent))
      devices.push_back(path);
  }
  std::ranges::sort(devices);
  LineList list;
  for (const auto& device : devices) {
    try {
      appendLines(device, sysfs, list.lines);
    } catch (const std::system_error& error) {
      list.refused.push_back(device.filename().string() + ": " + error.code().message());
    } catch (const std::exception& error) {
      list.refused.push_back(device.filename().string() + ": " + error.what());
    }
  }
  return list;
}

std::expected<std::optional<ListedLine>, std::string> findOptionalLine(const LineList& list,
                                                                       const std::string& name,
                                                                       const std::string& key) {
  const ListedLine* found = nullptr;
  for (const ListedLine& line : list.lines) {
    if (line.name != name) continue;
    if (found != nullptr)
      return std::unexpected(key + ": two GPIO lines are named " + quoted(name) + ", on " +
                             found->chip + " (" + found->chip_label + ") and " + line.chip + " (" +
                             line.chip_label + "): give them names of their own");
    found = &line;
  }
  if (found == nullptr) return std::nullopt;
  if (!found->consumer.empty())
    return std::unexpected(key + ": GPIO line " + quoted(name) + " on " + found->chip +
                           " is held by " + quoted(found->consumer) +
                           ": end that, or name another line");
  return *found;
}

std::expected<ListedLine, std::string> findLine(const LineList& list, const std::string& name,
                                                const std::string& key) {
  auto line = findOptionalLine(list, name, key);
  if (!line) return std::unexpected(std::move(line.error()));
  if (!*line) return std::unexpected(notFound(list, name, key));
  return std::move(**line);
}

}  // namespace hal::gpiod
