#include "hal/aravis/frame_id.h"
#include "tests/fuzz/fuzz_target.h"

/// Any sequence of 16 bit ids: the unwrapped count never runs backwards, and says the same on the
/// wire.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint64_t kLast = 65535;
  fuzz::Bytes bytes(data, size);
  hal::aravis::FrameIdUnwrapper ids;
  std::uint64_t before = 0;
  while (!bytes.empty()) {
    const std::uint64_t id = bytes.number<std::uint16_t>();
    const std::uint64_t unwrapped = ids.unwrap(id);
    fuzz::require(unwrapped >= before, "frame ids never run backwards");
    if (id != 0)
      fuzz::require((unwrapped + kLast - 1) % kLast + 1 == id, "the id on the wire stays");
    before = unwrapped;
  }
  return 0;
}
