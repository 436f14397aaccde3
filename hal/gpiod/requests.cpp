#include "hal/gpiod/requests.h"

#include <cerrno>
#include <exception>
#include <filesystem>
#include <system_error>

namespace hal::gpiod {
namespace {

std::string names(const std::vector<ListedLine>& lines) {
  std::string all;
  for (const ListedLine& line : lines) all += (all.empty() ? "\"" : ", \"") + line.name + '"';
  return all;
}

std::string adviceFor(const std::error_code& code) {
  switch (code.value()) {
    case EBUSY:
      return "end what holds them; gpioinfo names it";
    case EACCES:
    case EPERM:
      return "put the user into the group gpio";
    case ENODEV:
    case ENOENT:
      return "the chip went away: check its plug and its driver";
    default:
      return "the chip cannot do this: name lines of another one";
  }
}

}  // namespace

std::expected<::gpiod::line_request, std::string> requestLines(
    const std::vector<ListedLine>& lines, const ::gpiod::line_settings& settings,
    const std::string& key) {
  const std::string what = key + ": " + lines.front().chip + " refuses " + names(lines) + ": ";
  try {
    ::gpiod::line::offsets offsets;
    for (const ListedLine& line : lines) offsets.emplace_back(line.offset);
    ::gpiod::chip chip(std::filesystem::path("/dev") / lines.front().chip);
    return chip.prepare_request()
        .set_consumer(kConsumer)
        .add_line_settings(offsets, settings)
        .do_request();
  } catch (const std::system_error& error) {
    return std::unexpected(what + error.code().message() + ": " + adviceFor(error.code()));
  } catch (const std::exception& error) {
    return std::unexpected(what + error.what());
  }
}

}  // namespace hal::gpiod
