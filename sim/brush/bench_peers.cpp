#include "sim/brush/bench_peers.h"

#define HAVE_CSTDDEF  // Ipopt's headers ask for it
#include <nlopt.h>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <limits>

#include "sim/brush/free_program.h"
#include "sim/brush/sqp.h"
#include "sim/brush/tuft_step.h"

namespace fude {
namespace {

constexpr double frame_s = 1.0 / 250;
constexpr int frames = 2000;
constexpr double unasked = 1e300;  // microseconds of a frame that was not solved

// A peer asks for value and constraints at one point one after the other.
class Remembered {
 public:
  explicit Remembered(const Program& program) : program_(program) {}
  const Evaluation& at(const double* x) {
    const Variables asked = Eigen::Map<const Variables>(x, program_.low.size());
    if (last_.size() == 0 || asked != last_) {
      program_.evaluate(asked, evaluation_);
      last_ = asked;
    }
    return evaluation_;
  }

 private:
  const Program& program_;
  Variables last_;
  Evaluation evaluation_;
};

struct Attempt {
  Variables x;
  bool success = false;
};

double nlopt_value(unsigned n, const double* x, double* gradient, void* program) {
  const Evaluation& at = static_cast<Remembered*>(program)->at(x);
  if (gradient) std::copy_n(at.gradient.data(), n, gradient);
  return at.value;
}

// NLopt wants c ≤ 0, its gradient row by row.
void nlopt_constraints(unsigned m, double* result, unsigned n, const double* x, double* gradient,
                       void* program) {
  const Evaluation& at = static_cast<Remembered*>(program)->at(x);
  for (unsigned j = 0; j < m; ++j) {
    result[j] = -at.constraints[j];
    for (unsigned i = 0; gradient && i < n; ++i) gradient[j * n + i] = -at.jacobian(j, i);
  }
}

Attempt by_slsqp(const Program& program, const Variables& start, int constraints) {
  Remembered remembered(program);
  const auto n = static_cast<unsigned>(start.size());
  const auto m = static_cast<unsigned>(constraints);
  nlopt_opt opt = nlopt_create(NLOPT_LD_SLSQP, n);
  nlopt_set_min_objective(opt, nlopt_value, &remembered);
  const std::vector<double> slack(m, program.small_violation);
  nlopt_add_inequality_mconstraint(opt, m, nlopt_constraints, &remembered, slack.data());
  nlopt_set_lower_bounds(opt, program.low.data());
  nlopt_set_upper_bounds(opt, program.high.data());
  nlopt_set_ftol_rel(opt, 1e-6);
  nlopt_set_xtol_rel(opt, 1e-8);
  nlopt_set_maxeval(opt, 1000);
  Attempt attempt{start, false};
  double value = 0;
  const nlopt_result result = nlopt_optimize(opt, attempt.x.data(), &value);
  attempt.success = result > 0 && result != NLOPT_MAXEVAL_REACHED;
  nlopt_destroy(opt);
  return attempt;
}

class IpoptProgram : public Ipopt::TNLP {
 public:
  IpoptProgram(const Program& program, const Variables& start, int constraints)
      : program_(program), remembered_(program), start_(start), m_(constraints) {}

  bool get_nlp_info(int& n, int& m, int& jacobian, int& hessian, IndexStyleEnum& style) override {
    n = static_cast<int>(start_.size());
    m = m_;
    jacobian = n * m;
    hessian = 0;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(int n, double* low, double* high, int m, double* c_low, double* c_high) override {
    std::copy_n(program_.low.data(), n, low);
    std::copy_n(program_.high.data(), n, high);
    std::fill_n(c_low, m, 0.0);
    std::fill_n(c_high, m, 1e20);
    return true;
  }
  bool get_starting_point(int n, bool, double* x, bool, double*, double*, int, bool, double*) override {
    std::copy_n(start_.data(), n, x);
    return true;
  }
  bool eval_f(int, const double* x, bool, double& value) override {
    value = remembered_.at(x).value;
    return true;
  }
  bool eval_grad_f(int n, const double* x, bool, double* gradient) override {
    std::copy_n(remembered_.at(x).gradient.data(), n, gradient);
    return true;
  }
  bool eval_g(int, const double* x, bool, int m, double* constraints) override {
    std::copy_n(remembered_.at(x).constraints.data(), m, constraints);
    return true;
  }
  bool eval_jac_g(int n, const double* x, bool, int m, int, int* row, int* column, double* values) override {
    for (int j = 0, k = 0; j < m; ++j) {
      for (int i = 0; i < n; ++i, ++k) {
        if (values) {
          values[k] = remembered_.at(x).jacobian(j, i);
        } else {
          row[k] = j;
          column[k] = i;
        }
      }
    }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn status, int n, const double* x, const double*, const double*,
                         int, const double*, const double*, double, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    found.x = Eigen::Map<const Variables>(x, n);
    found.success = status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT;
  }
  Attempt found;

 private:
  const Program& program_;
  Remembered remembered_;
  Variables start_;
  int m_;
};

Attempt by_ipopt(Ipopt::IpoptApplication& application, const Program& program, const Variables& start,
                 int constraints) {
  const Ipopt::SmartPtr<IpoptProgram> self = new IpoptProgram(program, start, constraints);
  application.OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(GetRawPtr(self)));
  if (self->found.x.size() == 0) self->found.x = start;
  return self->found;
}

double violation_of(const Evaluation& at) { return std::max(0.0, -at.constraints.minCoeff()); }

}  // namespace

PeerBench bench_peers(const BrushSpec& spec, const BenchGesture& gesture, int runs) {
  const Tuft tuft = make_tuft(spec);
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication();
  ipopt->Options()->SetStringValue("hessian_approximation", "limited-memory");
  ipopt->Options()->SetStringValue("sb", "yes");
  ipopt->Options()->SetIntegerValue("print_level", 0);
  ipopt->Options()->SetIntegerValue("max_iter", 100);
  ipopt->Options()->SetNumericValue("tol", 1e-5);
  ipopt->Initialize();

  const int constraints = tuft.segments + 1;
  struct Peer {
    std::string name;
    int every;  // so many frames
    std::function<Attempt(const Program&, const Variables&)> solve;
  };
  const std::array<Peer, 2> peers = {
      {{"slsqp", 1, [&](const Program& p, const Variables& x) { return by_slsqp(p, x, constraints); }},
       {"ipopt", 100,
        [&](const Program& p, const Variables& x) { return by_ipopt(*ipopt, p, x, constraints); }}}};

  PeerBench bench;
  bench.frames = frames;
  bench.own.name = "fude";
  for (const Peer& peer : peers) bench.peers.push_back({peer.name, 0, {}, 0, 0, 0});
  bench.worst_gap = -std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> us(peers.size() + 1, std::vector<double>(frames, unasked));
  for (int run = 0; run < runs; ++run) {
    TuftState state = rest_state(tuft);
    for (int f = 0; f < frames; ++f) {
      const Pose<Paper, Handle> pose = reachable_pose(tuft, gesture.pose(spec, f * frame_s));
      // The same program that advance solves next.
      TuftState trial = state;
      const FrozenStep frozen = freeze_step(tuft, trial, pose, frame_s);
      const TuftProgram whole(tuft, frozen);
      const FreeProgram program(whole);
      const Variables start = program.free_of(trial.x).cwiseMax(program.low).cwiseMin(program.high);
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t p = 0; p < peers.size(); ++p) {
        if (f % peers[p].every != peers[p].every / 2) continue;
        const auto began = std::chrono::steady_clock::now();
        const Attempt attempt = peers[p].solve(program, start);
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - began;
        us[p + 1][static_cast<std::size_t>(f)] =
            std::min(us[p + 1][static_cast<std::size_t>(f)], took.count());
        if (run > 0) continue;
        Evaluation at;
        program.evaluate(attempt.x, at);
        PeerFigures& figures = bench.peers[p];
        ++figures.frames;
        figures.energy += at.value;
        figures.max_violation = std::max(figures.max_violation, violation_of(at) / spec.tuft_length_mm);
        figures.failures += attempt.success ? 0 : 1;
        if (violation_of(at) <= 1e-6 * spec.tuft_length_mm) best = std::min(best, at.value);
      }
      // All that advance does beside the solve is in our time.
      const auto began = std::chrono::steady_clock::now();
      const SolveReport own = advance(tuft, state, pose, frame_s, false);
      const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - began;
      us[0][static_cast<std::size_t>(f)] = std::min(us[0][static_cast<std::size_t>(f)], took.count());
      if (run > 0) continue;
      ++bench.own.frames;
      bench.own.energy += own.energy_mn_mm;
      bench.own.max_violation = std::max(bench.own.max_violation, own.violation_mm / spec.tuft_length_mm);
      bench.own.failures += own.converged ? 0 : 1;
      const double gap = (own.energy_mn_mm - best) / std::max(best, whole.small_energy);
      if (gap > bench.worst_gap) {
        bench.worst_gap = gap;
        bench.worst_frame = f;
      }
    }
  }
  bench.own.us_per_frame = times_of(us[0]);
  bench.own.energy /= bench.own.frames;
  for (std::size_t p = 0; p < peers.size(); ++p) {
    std::erase(us[p + 1], unasked);
    bench.peers[p].us_per_frame = times_of(us[p + 1]);
    bench.peers[p].energy /= bench.peers[p].frames;
  }
  return bench;
}

}  // namespace fude
