#pragma once

#include "hal/display.h"

namespace test {

/// A display that accepts every picture and shows none.
class NoDisplay final : public hal::Display {
 public:
  [[nodiscard]] hal::DisplayMode mode() const override { return {320, 180, 60}; }
  [[nodiscard]] std::string_view renderer() const override { return "none"; }
  [[nodiscard]] std::string_view uploadReason() const override { return "a test"; }
  [[nodiscard]] hal::Typesetter* typesetter() override { return nullptr; }
  [[nodiscard]] rt::Result<hal::RenderInstants> render(const hal::Scene& /*scene*/) override {
    return hal::RenderInstants{};
  }
  [[nodiscard]] rt::Result<rt::Timestamp> commit(std::uint64_t /*picture_id*/) override {
    return rt::now();
  }
  [[nodiscard]] std::optional<hal::PageFlip> tryPopFlip() override { return std::nullopt; }
  [[nodiscard]] std::optional<hal::DisplayTiming> timing() const override { return std::nullopt; }
  [[nodiscard]] std::optional<rt::Timestamp> nextCall() const override { return std::nullopt; }
  [[nodiscard]] hal::ScreenStatus screen() const override { return {}; }
  void releaseScreen() override {}
  void takeScreen() override {}
  void detach() override {}
};

}  // namespace test
