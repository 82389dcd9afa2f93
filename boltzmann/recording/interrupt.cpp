// The signal handler may only set flags. The simulation checks its flag after every step.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/launcher.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <mutex>
#include <utility>

namespace boltzmann {
namespace {

// A handler has no argument, so the simulation that it stops is a global variable.
std::atomic<Simulation*> stopped_by_signal{nullptr};
std::atomic<int> signals_seen{0};
std::atomic<bool> left_alone{false};
std::mutex installing;
int watches = 0, interrupts = 0;  // each Interrupt also has a SignalWatch
thread_local Interrupt* present = nullptr;
static_assert(std::atomic<Simulation*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);
// mpirun and srun forward SIGUSR1 without ending the run themselves.
std::array<int, 4> constexpr signals{SIGINT, SIGTERM, SIGHUP, SIGUSR1};
std::array<struct sigaction, 4> before;

std::atomic<bool> several_ranks{false};
std::atomic<std::int64_t> first_signal{0};  // time of the signal in ms
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

std::int64_t milliseconds() {
  std::timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1000000;
}

/// Launchers and batch systems send SIGTERM to ranks that have already received the signal of the terminal.
bool same_signal_again(int number) {
  return several_ranks && number != SIGUSR1 && milliseconds() - first_signal < 2000;
}

extern "C" void on_signal(int number) {
  if (signals_seen > 0 && same_signal_again(number)) return;
  if (signals_seen.fetch_add(1) > 0) _exit(130);
  first_signal = milliseconds();
  if (Simulation* simulation = stopped_by_signal.load()) simulation->stop();
}

}  // namespace

void Interrupt::leave_signals_alone() { left_alone = true; }

void Interrupt::stop() {
  if (!present) return;
  present->told_ = true;
  present->simulation_.stop();
}

SignalWatch::SignalWatch() {
  std::scoped_lock const lock(installing);
  if (left_alone || watches++ > 0) return;
  signals_seen = 0;
  several_ranks = !team().alone();
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // restart an interrupted write to a file
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i] == SIGUSR1 && team().alone()) {
      sigaction(SIGUSR1, nullptr, &before[i]);
      continue;
    }
    sigaction(signals[i], &action, &before[i]);
    if (signals[i] == SIGHUP && before[i].sa_handler == SIG_IGN) sigaction(SIGHUP, &before[i], nullptr);
  }
  signals_seen += LocalRanks::take_early_signals();
}

SignalWatch::~SignalWatch() {
  std::scoped_lock const lock(installing);
  if (left_alone || --watches > 0) return;
  for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before[i], nullptr);
}

bool SignalWatch::seen() const { return !left_alone && signals_seen > 0; }

Interrupt::Interrupt(Simulation& simulation) : simulation_(simulation) {
  if (left_alone) {
    before_ = std::exchange(present, this);
    return;
  }
  std::scoped_lock const lock(installing);
  Simulation* nobody = nullptr;
  if (!stopped_by_signal.compare_exchange_strong(nobody, &simulation) && watches == interrupts + 1)
    throw Error("two simulations can't both be stopped by Ctrl-C: one Interrupt at a time");
  ++interrupts;
  if (watch_.seen()) simulation.stop();
}

Interrupt::~Interrupt() {
  if (left_alone) {
    present = before_;
    return;
  }
  std::scoped_lock const lock(installing);
  --interrupts;
  Simulation* mine = &simulation_;
  stopped_by_signal.compare_exchange_strong(mine, nullptr);
}

bool Interrupt::seen() const { return left_alone ? told_ : signals_seen > 0; }

}  // namespace boltzmann
