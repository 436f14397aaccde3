#pragma once

#include <concepts>
#include <type_traits>

#include "appliance/trace/records.h"

/// The fields of every record with their names in the file, once, for writer and reader alike.
/// @p visit is called as visit("name", field) for each field in the file's order.
namespace appliance {

template <class T, class Record>
concept IsRecord = std::same_as<std::remove_const_t<T>, Record>;

template <IsRecord<TriggerRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("trigger", record.trigger);
  visit("deadline_ns", record.deadline);
  visit("trigger_edge_before_ns", record.trigger_edge_before);
  visit("trigger_edge_after_ns", record.trigger_edge_after);
}

template <IsRecord<LoopbackRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("trigger", record.trigger);
  visit("edge_ns", record.edge);
}

template <IsRecord<FrameRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("camera", record.camera);
  visit("status", record.status);
  visit("trigger", record.trigger);
  visit("frame_id", record.frame_id);
  visit("first_packet_ns", record.first_packet);
  visit("last_packet_ns", record.last_packet);
  visit("frame_ready_ns", record.frame_ready);
}

template <IsRecord<SetRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("trigger", record.trigger);
  visit("set_complete_ns", record.set_complete);
}

template <IsRecord<PictureRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("picture_id", record.picture_id);
  visit("mode", record.mode);
  visit("camera_wanted", record.camera_wanted);
  visit("camera_shown", record.camera_shown);
  visit("trigger", record.trigger);
  visit("second_camera", record.second.camera);
  visit("second_trigger", record.second.trigger);
  visit("substitute", record.substitute);
  visit("imported", record.imported);
  visit("wake_ns", record.wake);
  visit("target_point_begin_ns", record.target_point_begin);
  visit("target_point_end_ns", record.target_point_end);
  visit("homographies_begin_ns", record.homographies_begin);
  visit("homographies_end_ns", record.homographies_end);
  visit("warp_submit_ns", record.warp_submit);
  visit("upload_end_ns", record.upload_end);
  visit("warp_end_ns", record.warp_end);
  visit("commit_ns", record.commit);
  visit("button_event_ns", record.button_event);
}

template <IsRecord<FlipRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("picture_id", record.picture_id);
  visit("page_flip_ns", record.page_flip);
  visit("vblank", record.vblank);
}

template <IsRecord<GenlockRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("trigger", record.trigger);
  visit("state", record.state);
  visit("reason", record.reason);
  visit("hold_over", record.hold_over);
  visit("vblanks_per_trigger", record.vblanks_per_trigger);
  visit("phase_error_ns", record.phase_error);
  visit("lead_ns", record.lead);
  visit("vblank_period_ns", record.vblank_period);
  visit("unlocks", record.unlocks);
}

template <IsRecord<StallRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("cpu", record.cpu);
  visit("begin_ns", record.begin);
  visit("end_ns", record.end);
}

template <IsRecord<TracedThread> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("name", record.name);
  visit("policy", record.policy);
  visit("priority", record.priority);
  visit("cpu", record.cpu);
  visit("as_asked", record.as_asked);
}

template <IsRecord<RunRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("version", record.version);
  visit("cameras", record.cameras);
  visit("width_px", record.width_px);
  visit("height_px", record.height_px);
  visit("pixel_format", record.pixel_format);
  visit("trigger_hz", record.trigger_hz);
  visit("display_width_px", record.display_width_px);
  visit("display_height_px", record.display_height_px);
  visit("refresh_hz", record.refresh_hz);
  visit("renderer", record.renderer);
  visit("source_path", record.source_path);
  visit("history_sets", record.history_sets);
  visit("memory_bytes", record.memory_bytes);
  visit("memory_locked", record.memory_locked);
  visit("threads", record.threads);
  visit("degraded", record.degraded);
  visit("start_ns", record.start);
}

template <IsRecord<SummaryRecord> R, class Visitor>
void visitFields(R& record, Visitor&& visit) {
  visit("clean_stop", record.clean_stop);
  visit("stop_ns", record.stop);
  visit("cpu_seconds", record.cpu_seconds);
  visit("memory_bytes", record.memory_bytes);
  visit("frames_lost", record.frames_lost);
  visit("frames_away", record.frames_away);
  visit("frames_incomplete", record.frames_incomplete);
  visit("frames_unattributed", record.frames_unattributed);
  visit("pictures_skipped", record.pictures_skipped);
  visit("trace_dropped", record.trace_dropped);
}

}  // namespace appliance
