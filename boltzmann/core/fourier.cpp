// FFTW behind one interface: its planner runs in one thread at a time, its plans in several.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/fourier.hpp>

#include <fftw3.h>
#include <fmt/format.h>

#include <limits>
#include <mutex>
#include <new>

namespace boltzmann {
namespace {

std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

/// From real_to_halfcomplex on, in the order of FourierKind.
constexpr fftw_r2r_kind real_kinds[] = {FFTW_R2HC,    FFTW_HC2R,    FFTW_REDFT00, FFTW_RODFT00,
                                        FFTW_REDFT01, FFTW_REDFT10, FFTW_RODFT01, FFTW_RODFT10};

fftw_complex* as_complex(double* data) { return reinterpret_cast<fftw_complex*>(data); }

}  // namespace

FourierArray::FourierArray(std::size_t size) : size_(size) {
  if (size == 0) return;
  if (size > std::numeric_limits<std::size_t>::max() / sizeof(double)) throw std::bad_alloc();
  data_.reset(fftw_alloc_real(size));
  if (!data_) throw std::bad_alloc();
}

void FourierArray::Free::operator()(double* data) const { fftw_free(data); }

struct LineTransform::Plan {
  FourierKind kind;
  fftw_plan plan;

  Plan(FourierKind k, std::size_t length, std::size_t lines) : kind(k) {
    int const n = static_cast<int>(length), many = static_cast<int>(lines);
    unsigned const how = FFTW_ESTIMATE | FFTW_DESTROY_INPUT;
    FourierArray input(2 * (length + 2) * lines), output(2 * (length + 2) * lines);
    double *const in = input.data(), *const out = output.data();
    std::lock_guard const lock(planner());
    switch (kind) {
      case FourierKind::real_to_complex:
        plan = fftw_plan_many_dft_r2c(1, &n, many, in, nullptr, many, 1, as_complex(out), nullptr, many, 1, how);
        break;
      case FourierKind::complex_to_real:
        plan = fftw_plan_many_dft_c2r(1, &n, many, as_complex(in), nullptr, many, 1, out, nullptr, many, 1, how);
        break;
      case FourierKind::complex_forward:
      case FourierKind::complex_backward:
        plan = fftw_plan_many_dft(1, &n, many, as_complex(in), nullptr, many, 1, as_complex(out), nullptr, many, 1,
                                  kind == FourierKind::complex_forward ? FFTW_FORWARD : FFTW_BACKWARD, how);
        break;
      default: {
        fftw_r2r_kind const r2r =
            real_kinds[static_cast<int>(kind) - static_cast<int>(FourierKind::real_to_halfcomplex)];
        plan = fftw_plan_many_r2r(1, &n, many, in, nullptr, many, 1, out, nullptr, many, 1, &r2r, how);
      }
    }
    if (plan == nullptr) throw std::bad_alloc();
  }
  ~Plan() {
    std::lock_guard const lock(planner());
    fftw_destroy_plan(plan);
  }
  Plan(Plan const&) = delete;
  Plan& operator=(Plan const&) = delete;
};

LineTransform::LineTransform(FourierKind kind, std::size_t length, std::size_t lines) {
  constexpr auto largest = static_cast<std::size_t>(std::numeric_limits<int>::max());
  std::size_t const smallest = kind == FourierKind::cosine ? 2 : 1;
  if (length < smallest || length > largest || lines < 1 || lines > largest)
    throw Error(fmt::format("Fourier transform: {} line(s) of {} numbers; allowed are lines of {} to {} numbers", lines,
                            length, smallest, largest));
  plan_ = std::make_shared<Plan const>(kind, length, lines);
}

void LineTransform::execute(double* input, double* output) const {
  switch (plan_->kind) {
    case FourierKind::real_to_complex:
      fftw_execute_dft_r2c(plan_->plan, input, as_complex(output));
      break;
    case FourierKind::complex_to_real:
      fftw_execute_dft_c2r(plan_->plan, as_complex(input), output);
      break;
    case FourierKind::complex_forward:
    case FourierKind::complex_backward:
      fftw_execute_dft(plan_->plan, as_complex(input), as_complex(output));
      break;
    default:
      fftw_execute_r2r(plan_->plan, input, output);
  }
}

std::size_t fast_even_length(std::size_t at_least) {
  for (std::size_t length = at_least < 2 ? 2 : at_least + at_least % 2;; length += 2) {
    std::size_t rest = length;
    for (std::size_t const prime : {2, 3, 5, 7})
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return length;
  }
}

}  // namespace boltzmann
