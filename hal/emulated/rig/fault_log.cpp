#include "hal/emulated/rig/fault_log.h"

#include <cerrno>
#include <cinttypes>
#include <cstring>

namespace emulator {

std::expected<FaultLog, std::string> FaultLog::open(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "we");
  if (file == nullptr) {
    return std::unexpected("cannot write the fault log " + path + ": " + std::strerror(errno));
  }
  std::fputs("instant_ns,camera,fault\n", file);
  std::fflush(file);
  return FaultLog(file);
}

void FaultLog::add(rt::Timestamp at, std::uint32_t camera, std::string_view text) {
  std::fprintf(file_.get(), "%" PRId64 ",%" PRIu32 ",%.*s\n", rt::toNs(at), camera + 1,
               static_cast<int>(text.size()), text.data());
}

void FaultLog::addCommand(rt::Timestamp at, std::uint32_t camera, const FaultCommand& command) {
  add(at, camera, faultText(command));
  std::fflush(file_.get());  // who commanded it may read on
}

void FaultLog::addEffect(rt::Timestamp at, std::uint32_t camera, const FaultEffect& effect) {
  std::string text = "effect ";
  text.append(nameOf(effect.fault)).append(" trigger ").append(std::to_string(effect.trigger));
  if (effect.frame_id != 0) text += " frame " + std::to_string(effect.frame_id);
  if (effect.packets_lost != 0) text += " packets " + std::to_string(effect.packets_lost);
  add(at, camera, text);
}

}  // namespace emulator
