#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace windlass::app {

/// Progress of long work on stderr: one line that renews itself where stderr is a terminal, a plain line every few
/// seconds otherwise, nothing with --quiet. Costs one clock reading a call when nothing is due.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// True if `update` would show something now: lets the caller skip making the text.
  bool due() const;
  /// What is being done, e.g. "branch 2, point 118, T = 0.4312".
  void update(std::string_view text);
  /// A line that stays, e.g. a special point found.
  void note(std::string_view text);
  /// Wipes the live line.
  void finish();

 private:
  enum class Style { silent, lines, live };
  using Clock = std::chrono::steady_clock;

  Style style_;
  Clock::time_point next_;
  bool line_open_ = false;
};

/// Shows, while it lives, that work goes on which reports nothing itself: what is done and for how long already.
class Heartbeat {
 public:
  Heartbeat(std::string what, bool quiet);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  void beat();

  std::string what_;
  Progress progress_;
  std::mutex mutex_;
  std::condition_variable over_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace windlass::app
