#include "appliance/tools/trace_text.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>

namespace appliance {
namespace {

/// "  frame_ready   12.345" relative to @p zero; an instant that did not happen is a dash.
std::string instant(const char* name, rt::Timestamp at, rt::Timestamp zero) {
  std::array<char, 80> text{};
  if (at == rt::Timestamp{})
    (void)std::snprintf(text.data(), text.size(), "  %-22s %12s\n", name, "-");
  else
    (void)std::snprintf(text.data(), text.size(), "  %-22s %12.3f ms\n", name,
                        static_cast<double>((at - zero).count()) / 1e6);
  return text.data();
}

const TriggerRecord* findTrigger(const Trace& trace, std::uint64_t trigger) {
  const auto found = std::ranges::find(trace.triggers, trigger, &TriggerRecord::trigger);
  return found == trace.triggers.end() ? nullptr : &*found;
}

std::string frameText(const FrameRecord& frame, rt::Timestamp zero) {
  return "camera " + std::to_string(frame.camera + 1) + ", frame id " +
         std::to_string(frame.frame_id) + ", " + std::string(nameOf(frame.status)) + "\n" +
         instant("first_packet", frame.first_packet, zero) +
         instant("last_packet", frame.last_packet, zero) +
         instant("frame_ready", frame.frame_ready, zero);
}

std::string pictureText(const Trace& trace, const PictureRecord& picture, rt::Timestamp zero) {
  std::string text = "picture " + std::to_string(picture.picture_id) + ", " +
                     std::string(nameOf(picture.mode)) + ", camera " +
                     std::to_string(picture.camera_shown + 1);
  if (picture.substitute) text += " instead of " + std::to_string(picture.camera_wanted + 1);
  if (picture.second.trigger != 0) {
    text += ", with trigger " + std::to_string(picture.second.trigger) + " of camera " +
            std::to_string(picture.second.camera + 1);
  }
  text += "\n";
  if (picture.button_event != rt::Timestamp{})
    text += instant("button_event", picture.button_event, zero);
  text += instant("wake", picture.wake, zero) +
          instant("target_point_end", picture.target_point_end, zero) +
          instant("homographies_end", picture.homographies_end, zero) +
          instant("warp_submit", picture.warp_submit, zero) +
          instant("upload_end", picture.upload_end, zero) +
          instant("warp_end", picture.warp_end, zero) + instant("commit", picture.commit, zero);
  for (const FlipRecord& flip : trace.flips)
    if (flip.picture_id == picture.picture_id) text += instant("page_flip", flip.page_flip, zero);
  return text;
}

std::string triggerText(const TriggerRecord& trigger) {
  return "trigger " + std::to_string(trigger.trigger) + "\n" +
         instant("deadline", trigger.deadline, trigger.trigger_edge_before) +
         instant("trigger_edge, from", trigger.trigger_edge_before, trigger.trigger_edge_before) +
         instant("trigger_edge, to", trigger.trigger_edge_after, trigger.trigger_edge_before);
}

}  // namespace

std::string traceOverview(const Trace& trace) {
  const RunRecord& run = trace.run;
  std::array<char, 640> text{};
  (void)std::snprintf(text.data(), text.size(),
                      "%u cameras, %ux%u %s, %.6g Hz; picture %ux%u at %.6g Hz by %s\n"
                      "frames to the renderer by %s\n"
                      "%zu triggers, %zu frames, %zu complete sets, %zu pictures, %zu page flips\n",
                      run.cameras, run.width_px, run.height_px, run.pixel_format.c_str(),
                      run.trigger_hz, run.display_width_px, run.display_height_px, run.refresh_hz,
                      run.renderer.c_str(), run.source_path.c_str(), trace.triggers.size(),
                      trace.frames.size(), trace.sets.size(), trace.pictures.size(),
                      trace.flips.size());
  std::string overview = text.data();
  for (const std::string& line : run.degraded) overview += "degraded: " + line + "\n";
  if (!trace.summary)
    overview += "incomplete: kagamid did not shut down cleanly\n";
  else if (trace.summary->trace_dropped > 0)
    overview += std::to_string(trace.summary->trace_dropped) + " records were lost\n";
  return overview;
}

std::expected<std::string, std::string> lifeOfTrigger(const Trace& trace, std::uint64_t trigger,
                                                      std::optional<std::uint32_t> camera) {
  const TriggerRecord* fired = findTrigger(trace, trigger);
  if (fired == nullptr)
    return std::unexpected("the trace has no trigger " + std::to_string(trigger));
  const rt::Timestamp zero = fired->trigger_edge_before;
  std::string text = triggerText(*fired);
  for (const FrameRecord& frame : trace.frames)
    if (frame.trigger == trigger && (!camera || frame.camera == *camera))
      text += frameText(frame, zero);
  for (const SetRecord& set : trace.sets)
    if (set.trigger == trigger)
      text += "frame set\n" + instant("set_complete", set.set_complete, zero);
  for (const PictureRecord& picture : trace.pictures)
    if (picture.trigger == trigger && (!camera || picture.camera_shown == *camera))
      text += pictureText(trace, picture, zero);
  return text;
}

std::expected<std::string, std::string> lifeOfPicture(const Trace& trace,
                                                      std::uint64_t picture_id) {
  const auto found = std::ranges::find(trace.pictures, picture_id, &PictureRecord::picture_id);
  if (found == trace.pictures.end())
    return std::unexpected("the trace has no picture " + std::to_string(picture_id));
  const TriggerRecord* fired = findTrigger(trace, found->trigger);
  if (fired == nullptr) return pictureText(trace, *found, found->wake);
  const rt::Timestamp zero = fired->trigger_edge_before;
  std::string text = triggerText(*fired);
  for (const FrameRecord& frame : trace.frames)
    if (frame.trigger == found->trigger && frame.camera == found->camera_shown)
      text += frameText(frame, zero);
  return text + pictureText(trace, *found, zero);
}

}  // namespace appliance
