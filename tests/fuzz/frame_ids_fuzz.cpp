#include <optional>

#include "hal/aravis/frame_id.h"
#include "tests/fuzz/fuzz_target.h"

/// Any sequence of 16 bit ids: the unwrapped count never runs backwards, and says the same on the
/// wire. A camera that was seen to use the id 0 has one id more.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint64_t kLast = 65535;
  fuzz::Bytes bytes(data, size);
  hal::aravis::FrameIdUnwrapper ids;
  std::uint64_t before = 0;
  std::optional<std::uint64_t> at_zero;  // the count of the newest frame with the id 0
  while (!bytes.empty()) {
    const std::uint64_t id = bytes.number<std::uint16_t>();
    const std::uint64_t unwrapped = ids.unwrap(id);
    fuzz::require(unwrapped >= before, "frame ids never run backwards");
    if (id == 0) at_zero = unwrapped;
    if (at_zero)
      fuzz::require((unwrapped - *at_zero) % (kLast + 1) == id, "the id on the wire stays");
    else
      fuzz::require((unwrapped + kLast - 1) % kLast + 1 == id, "the id on the wire stays");
    before = unwrapped;
  }
  return 0;
}
