#include "ui-kms/kms/sync_file.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <linux/sync_file.h>
#include <sys/ioctl.h>

namespace ui::kms {

std::optional<rt::Timestamp> signalledAt(int fence) {
  constexpr std::int32_t kSignalled = 1;
  std::array<sync_fence_info, 8> parts{};
  sync_file_info info{};
  info.num_fences = parts.size();
  info.sync_fence_info = reinterpret_cast<std::uintptr_t>(parts.data());
  if (::ioctl(fence, SYNC_IOC_FILE_INFO, &info) != 0 || info.status != kSignalled) {
    return std::nullopt;
  }
  std::uint64_t last_ns = 0;
  for (std::uint32_t i = 0; i < info.num_fences; ++i) {
    last_ns = std::max<std::uint64_t>(last_ns, parts[i].timestamp_ns);
  }
  return rt::fromNs(static_cast<std::int64_t>(last_ns));
}

}  // namespace ui::kms
