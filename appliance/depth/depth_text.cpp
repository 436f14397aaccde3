#include "appliance/depth/depth_text.h"

#include <chrono>
#include <cmath>

namespace appliance {
namespace {

Phrase stateOf(const hal::DepthStatus& sensor) {
  switch (sensor.state) {
    case hal::DepthState::kConnecting:
      return sensor.name.empty() ? phrase<Word::kDepthConnecting>()
                                 : phrase<Word::kDepthConnectingTo>(sensor.name);
    case hal::DepthState::kStreaming:
      return phrase<Word::kDepthStreaming>(sensor.name);
    case hal::DepthState::kLost:
      return phrase<Word::kDepthLost>(sensor.name);
    case hal::DepthState::kEnded:
      return phrase<Word::kDepthEnded>(sensor.name);
  }
  return {};
}

Phrase picturesOf(const DepthReport& report) {
  const hal::DepthStatus& sensor = report.sensor;
  if (sensor.colour)
    return phrase<Word::kDepthPictures>(sensor.width_px, sensor.height_px, report.rate_hz);
  return phrase<Word::kDepthPicturesWithoutColour>(sensor.width_px, sensor.height_px,
                                                   report.rate_hz);
}

Phrase wordsOf(const DepthSight& sight) {
  const auto percent = std::lround(100 * sight.measured_share);
  if (!sight.middle_m) return phrase<Word::kDepthSightWithoutMiddle>(percent);
  return phrase<Word::kDepthSight>(percent, *sight.middle_m);
}

std::string readerText(const DepthReaderStatus& reader) {
  std::string text = textOf(phrase<Word::kDepthReader>(reader.name, reader.taken, reader.lost));
  if (reader.refused > 0)
    text += ", " + textOf(phrase<Word::kDepthReaderRefused>(reader.refused, reader.pins));
  return text;
}

}  // namespace

std::string depthText(const DepthReport& report) {
  const hal::DepthStatus& sensor = report.sensor;
  std::string text = textOf(stateOf(sensor));
  if (sensor.frames == 0) return text;
  text += ", " + textOf(picturesOf(report));
  text += "; " + textOf(phrase<Word::kDepthCounts>(sensor.frames, sensor.lost));
  if (sensor.without_colour > 0)
    text += ", " + textOf(phrase<Word::kDepthColourMissing>(sensor.without_colour));
  if (report.sight) text += "; " + textOf(wordsOf(*report.sight));
  if (sensor.returns > 0) text += "; " + textOf(phrase<Word::kDepthReturns>(sensor.returns));
  if (report.age && sensor.state != hal::DepthState::kStreaming) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(*report.age);
    text += "; " + textOf(phrase<Word::kDepthLastPicture>(seconds.count()));
  }
  for (const DepthReaderStatus& reader : report.readers)
    if (reader.taken + reader.refused > 0) text += "; " + readerText(reader);
  return text;
}

Phrase depthTrouble(const DepthReport& report) {
  const hal::DepthStatus& sensor = report.sensor;
  if (!sensor.message.empty()) return phrase<Word::kDepthTrouble>(sensor.message);
  if (sensor.state == hal::DepthState::kEnded) return phrase<Word::kDepthRecordingOver>();
  return {};
}

}  // namespace appliance
