#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "appliance/status/status.h"

namespace appliance {

struct BusObject;
struct Shared;

/// Something asked of the box that is no command of the director.
struct Request {
  std::string verb;           ///< the part, a dot, what to do: "screen.release"
  std::string argument = {};  ///< as the verb defines it
};

/// The part's answer to a request: done, or one line why not. Nothing: it belongs to another part.
using Answer = std::optional<std::expected<void, std::string>>;

/// One subsystem of the running box. It owns its devices, its threads, its settings and its section
/// of the status. It shares with the others what Shared lists, and knows none of them.
///
/// Parts are made in the order of the table in parts.cpp, started in the same order and stopped in
/// reverse. Making one opens its devices and makes its loops; nothing of it runs before start().
///
/// Threads  All members: main. stop() may be called by another thread while main waits for it. A
///          part's own threads are its own; none of them calls through this interface.
/// Errors   start(): one line for a person, without which the box cannot run. What the box can do
///          without is a remark (Shared::remarks, report()) and no error.
class Part {
 public:
  virtual ~Part() = default;

  /// For messages: "depth".
  [[nodiscard]] virtual std::string_view name() const = 0;

  [[nodiscard]] virtual std::expected<void, std::string> start() = 0;

  /// Returns when nothing of the part runs. Idempotent; also called after a start() that failed or
  /// never came.
  virtual void stop() = 0;

  /// Adds what the part knows to @p status: the core's members that are its own, a section,
  /// remarks. From before start() until after stop().
  virtual void report(Status& status) const = 0;

  /// Adds the part's own objects on the bus to @p objects. They hold for the part's life; their
  /// callbacks run on the main thread, between start() and stop().
  virtual void addBusObjects(std::vector<BusObject>& /*objects*/) {}

  [[nodiscard]] virtual Answer handle(const Request& /*request*/) { return std::nullopt; }
};

/// Opens the part's devices and makes it. Null: it is not configured.
/// Errors  One line: the box cannot run.
using MadePart = std::expected<std::unique_ptr<Part>, std::string>;
using MakePart = MadePart (*)(const Shared&);

/// One line of the table of parts.
struct PartEntry {
  MakePart make;
  std::uint32_t pins_per_camera = 0;  ///< of its readers of the frame history
};

}  // namespace appliance
