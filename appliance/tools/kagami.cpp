// kagami: the command line. Talks to the running daemon, or works on the files of a run.
// Composition point of this program: the one place of the tools that names the picture side.

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "appliance/tools/commands.h"
#include "appliance/version/version.h"
#include "ui-kms/film.h"

namespace appliance {

namespace {

struct FilmOptions {
  std::filesystem::path record;
  std::filesystem::path out;
  std::filesystem::path contact_sheet;
  std::string font;
};

/// The stills of a recording in the order they were shown, each with what it shows.
std::vector<ui::CaptionedStill> stillsOf(const std::filesystem::path& record) {
  const std::filesystem::path list = record / "pictures.jsonl";
  std::ifstream in(list);
  if (!in) fail(list.string() + ": cannot be read (" + std::strerror(errno) + ")");
  std::vector<ui::CaptionedStill> stills;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const auto picture = nlohmann::json::parse(line, nullptr, false);
    try {
      const auto& still = picture.at("still");
      if (still.is_null()) continue;
      const std::filesystem::path png = record / still.get<std::string>();
      std::erase_if(stills, [&](const auto& before) { return before.png == png; });
      stills.push_back({png, picture.at("mode").get<std::string>() + ": camera " +
                                 std::to_string(picture.at("camera").get<unsigned>() + 1) +
                                 ", trigger " +
                                 std::to_string(picture.at("trigger").get<std::uint64_t>())});
    } catch (const nlohmann::json::exception&) {
      fail(list.string() + ":" + std::to_string(number) + ": not a line of a recording");
    }
  }
  return stills;
}

void makeFilm(const FilmOptions& options) {
  if (!options.out.empty()) {
    const auto film = ui::encodeVideo(options.record / "video.film", options.out);
    if (!film) fail(film.error());
    std::printf("%s: %llu pictures, %.3g Hz, %s\n", options.out.c_str(),
                static_cast<unsigned long long>(film->pictures), film->hz, film->codec.c_str());
  }
  if (!options.contact_sheet.empty()) {
    const auto stills = stillsOf(options.record);
    if (stills.empty()) fail(options.record.string() + ": this recording holds no stills");
    const auto made = ui::contactSheet(stills, options.contact_sheet, options.font);
    if (!made) fail(made.error());
    std::printf("%s: %zu stills\n", options.contact_sheet.c_str(), stills.size());
  }
}

void addFilmCommand(CLI::App& kagami) {
  const auto options = std::make_shared<FilmOptions>();
  CLI::App* command = kagami.add_subcommand("film", "Make a video and a contact sheet of a run");
  command->add_option("--record", options->record, "what kagamid recorded ([record] directory)")
      ->required();
  command->add_option("--out", options->out, "the video, e.g. demo.mp4");
  command->add_option("--contact-sheet", options->contact_sheet, "all stills on one sheet");
  command->add_option("--font", options->font, "for the captions");
  command->callback([options] { makeFilm(*options); });
}

}  // namespace
}  // namespace appliance

int main(int argc, char** argv) {
  CLI::App kagami{
      "The command line of Kagami. The first commands speak to the running kagamid, the others\n"
      "work on the files of a run.",
      "kagami"};
  kagami.require_subcommand(1);
  kagami.set_version_flag("--version", std::string(appliance::version()));
  appliance::ControlPlace place;
  kagami.add_option("--bus", place.bus, "system, session or a D-Bus address")
      ->capture_default_str();
  kagami.add_option("--name", place.name, "the daemon's name on the bus")->capture_default_str();
  appliance::addControlCommands(kagami, place);
  appliance::addMetricsCommand(kagami, place);
  appliance::addConfigCommand(kagami);
  appliance::addPlanCommand(kagami);
  appliance::addDepthCommand(kagami, place);
  appliance::addTraceCommand(kagami);
  appliance::addReportCommand(kagami);
  appliance::addFilmCommand(kagami);
  try {
    CLI11_PARSE(kagami, argc, argv);
  } catch (const appliance::CommandFailed& failed) {
    return failed.status;
  }
  return 0;
}
