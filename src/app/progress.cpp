#include "app/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace windlass::app {

namespace {

constexpr std::chrono::milliseconds live_period{100};
constexpr std::chrono::seconds line_period{5};

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1 : 79;
}

void print_line(std::string_view text) {
  std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data());
}

}  // namespace

Progress::Progress(bool quiet)
    : style_(quiet                   ? Style::silent
             : isatty(STDERR_FILENO) ? Style::live
                                     : Style::lines),
      // Short work stays silent in a log; a person at a terminal sees something soon.
      next_(Clock::now() +
            (style_ == Style::live ? Clock::duration(live_period) : Clock::duration(line_period))) {}

Progress::~Progress() { finish(); }

bool Progress::due() const { return style_ != Style::silent && Clock::now() >= next_; }

void Progress::update(std::string_view text) {
  if (!due()) return;
  if (style_ == Style::lines) {
    print_line(text);
    next_ = Clock::now() + line_period;
    return;
  }
  text = text.substr(0, terminal_width());  // a wrapped line could not be wiped
  std::fprintf(stderr, "\r\033[K%.*s", static_cast<int>(text.size()), text.data());
  std::fflush(stderr);
  line_open_ = true;
  next_ = Clock::now() + live_period;
}

void Progress::note(std::string_view text) {
  if (style_ == Style::silent) return;
  finish();
  print_line(text);
}

Heartbeat::Heartbeat(std::string what, bool quiet)
    : what_(std::move(what)), progress_(quiet), thread_([this] { beat(); }) {}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  over_.notify_all();
  thread_.join();
}

void Heartbeat::beat() {
  const auto begin = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, live_period, [this] { return stop_; })) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    if (progress_.due()) progress_.update(fmt::format("{}: {:.0f} s; Ctrl-C ends it", what_, passed.count()));
  }
}

void Progress::finish() {
  if (!line_open_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  line_open_ = false;
}

}  // namespace windlass::app
