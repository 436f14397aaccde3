#include "tests/soak/memory_growth.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <unistd.h>

namespace soak {
namespace {

std::int64_t median(std::span<const Holding> held, std::uint64_t Holding::* what) {
  std::vector<std::uint64_t> values;
  for (const Holding& one : held) values.push_back(one.*what);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return static_cast<std::int64_t>(*middle);
}

}  // namespace

std::optional<Growth> growthOf(std::span<const Holding> held, rt::Timestamp warm_up_end) {
  if (held.empty() || held.back().at - 2 * kSpan < warm_up_end) return std::nullopt;
  const auto at = [&](rt::Timestamp t) {
    return std::ranges::lower_bound(held, t, {}, &Holding::at);
  };
  const std::span<const Holding> first(at(warm_up_end), at(warm_up_end + kSpan));
  const std::span<const Holding> last(at(held.back().at - kSpan), held.end());
  if (first.empty()) return std::nullopt;
  return Growth{
      .resident_bytes =
          median(last, &Holding::resident_bytes) - median(first, &Holding::resident_bytes),
      .open_files = median(last, &Holding::open_files) - median(first, &Holding::open_files)};
}

std::optional<Holding> look(int pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  std::ifstream statm(folder + "/statm");
  std::uint64_t size_pages = 0;
  std::uint64_t resident_pages = 0;
  if (!(statm >> size_pages >> resident_pages)) return std::nullopt;
  std::error_code gone;
  const std::filesystem::directory_iterator files(folder + "/fd", gone);
  return Holding{
      .at = rt::now(),
      .resident_bytes = resident_pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)),
      .open_files = static_cast<std::uint64_t>(std::distance(begin(files), end(files)))};
}

}  // namespace soak
