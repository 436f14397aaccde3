#pragma once

#include <istream>

#include <nlohmann/json.hpp>

/// The figures of a report once more, straight from the files and by docs/trace.md alone: this code
/// shares nothing with appliance/tools. @p wire_log may be null.
nlohmann::json recomputedReport(std::istream& trace, std::istream* wire_log, double warm_up_s);

/// Expects every figure of @p recomputed in @p report, numbers within rounding.
void expectSameFigures(const nlohmann::json& report, const nlohmann::json& recomputed);
