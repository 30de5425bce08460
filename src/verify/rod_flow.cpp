#include "windlass/verify/rod_flow.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <stdexcept>
#include <string>

namespace windlass::verify {

using Eigen::Vector3d;
using Eigen::Vector4d;

Stiffness::Stiffness(const scene::Rod& rod)
    : K(rod.bending_stiffness_2, rod.bending_stiffness, rod.twist_ratio * rod.bending_stiffness),
      u_hat(0.0, -rod.natural_curvature, rod.natural_twist),
      k(rod.compliance()),
      weight(rod.weight[0], rod.weight[1], rod.weight[2]) {}

Vector3d Stiffness::strain(const Section& section) const {
  return (rotation(section.q).transpose() * section.m).cwiseQuotient(K) + u_hat;
}

double Stiffness::energy_density(const Section& section) const {
  const Vector3d e = strain(section) - u_hat;
  return 0.5 * e.dot(K.cwiseProduct(e));
}

double Stiffness::hamiltonian(const Section& section) const {
  const Vector3d m_body = rotation(section.q).transpose() * section.m;
  const double tension = section.n.dot(tangent(section));
  return m_body.dot(strain(section)) - energy_density(section) + tension + 0.5 * k * tension * tension +
         weight.dot(section.r);
}

double Stiffness::stretch(const Section& section) const { return 1.0 + k * section.n.dot(tangent(section)); }

Eigen::Matrix3d rotation(const Vector4d& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

Vector3d tangent(const Section& section) { return rotation(section.q).col(2); }

double surface_pressure(const Section& section, double bending_stiffness) {
  const double B = bending_stiffness;
  const Vector3d& m = section.m;
  const Vector3d& n = section.n;
  const Vector3d t = tangent(section);
  const Vector3d N(section.r.x(), section.r.y(), 0.0);
  const Vector3d w = m.cross(t) / B;                           // t'
  const Vector3d m_rate = n.cross(t);                          // m'
  const Vector3d w_rate = (m_rate.cross(t) + m.cross(w)) / B;  // w' = (t (n·t) - n + m×w)/B
  // B w'' = m''×t + 2 m'×w + m×w' with m'' = n'×t + n×w; the p-part is (n'×t)×t = t (n'·t) - n', n' = -p(N + mu d), d·N = 0
  const Vector3d rest = n.cross(w).cross(t) + 2.0 * m_rate.cross(w) + m.cross(w_rate);
  const double without_p =
      3.0 * w.head<2>().squaredNorm() + 4.0 * t.head<2>().dot(w_rate.head<2>()) + N.dot(rest) / B;
  const double along = N.dot(t);  // zero on the cylinder
  const double per_p = (N.squaredNorm() - along * along) / B;
  return -without_p / per_p;
}

double stretched_surface_pressure(const Section& section, const Stiffness& stiffness) {
  const double B = stiffness.K[0], k = stiffness.k, stretch = stiffness.stretch(section);
  const Vector3d &m = section.m, &n = section.n, t = tangent(section);
  const Vector3d N(section.r.x(), section.r.y(), 0.0);
  const auto across = [](const Vector3d& a, const Vector3d& b) { return a.head<2>().dot(b.head<2>()); };
  const Vector3d w = m.cross(t) / B, m1 = stretch * n.cross(t), w1 = (m1.cross(t) + m.cross(w)) / B;
  // h = N·t, N' = λ t_h; n' = −p N, n''·t = −p λ |t_h|²: where N·t = 0 the rate of p does not enter.
  const auto third = [&](double p) {
    const Vector3d n1 = -p * N;
    const double stretch1 = k * (n1.dot(t) + n.dot(w)),
                 stretch2 = k * (-p * stretch * across(t, t) + 2.0 * n1.dot(w) + n.dot(w1));
    const Vector3d m2 = stretch1 * n.cross(t) + stretch * (n1.cross(t) + n.cross(w));
    const Vector3d w2 = (m2.cross(t) + 2.0 * m1.cross(w) + m.cross(w1)) / B;
    return stretch2 * across(t, t) + 5.0 * stretch1 * across(t, w) + 3.0 * stretch * across(w, w) +
           4.0 * stretch * across(t, w1) + N.dot(w2);
  };
  const double none = third(0.0);
  return -none / (third(1.0) - none);
}

bool has_layers(const Stiffness& stiffness, const Shape& shape) {
  return shape.drags_alone() && (shape.has_couple() || stiffness.stretches());
}

double taken_by_friction(const Section& section, const Stiffness& stiffness) {
  const double B = stiffness.K[0], k = stiffness.k, stretch = stiffness.stretch(section);
  const Vector3d N(section.r.x(), section.r.y(), 0.0), t = tangent(section);
  const double s = t.z(), c = t.dot(Vector3d::UnitZ().cross(N)), turn = section.m.dot(N) / B;
  const double a = section.m.dot(t) - 3.0 * B * stretch * s * c;
  const double stretch1 = -k * turn * (a * c * c + section.n.dot(t.cross(N))) / (1.0 + k * B * c * c * c * c);
  return (turn * a + B * stretch1 * c * c) / stretch - section.n.dot(N);
}

double layer_width(const Section& section, const Stiffness& stiffness, const Shape& shape) {
  const double soft = stiffness.k * stiffness.K[0], stretch = stiffness.stretch(section);
  const Vector3d t = tangent(section);
  const double c2 = t.head<2>().squaredNorm();
  return shape.along(section.r, stretch * t) * (shape.arm() + soft * c2) / (stretch * (1.0 + soft * c2 * c2));
}

double polynomial(const Eigen::VectorXd& places, const Eigen::VectorXd& values, double s) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < places.size(); ++i) {
    double term = values(i);
    for (Eigen::Index k = 0; k < places.size(); ++k)
      if (k != i) term *= (s - places(k)) / (places(i) - places(k));
    sum += term;
  }
  return sum;
}

double plane_pressure(const Section& section, const Stiffness& stiffness, const Vector3d& normal) {
  const Eigen::Matrix3d to_body = rotation(section.q).transpose();
  const Vector3d m = to_body * section.m, n = to_body * section.n, N = to_body * normal,
                 e3 = Vector3d::UnitZ();
  const auto strained = [&](const Vector3d& moment) { return Vector3d(moment.cwiseQuotient(stiffness.K)); };
  const Vector3d u = stiffness.strain(section);
  const double stretch = stiffness.stretch(section);
  const Vector3d n1 = -u.cross(n) - to_body * stiffness.weight;
  const double stretch1 = stiffness.k * n1.z();  // the plane does not push along the rod
  const Vector3d m1 = stretch * n.cross(e3) - u.cross(m), u1 = strained(m1);
  const Vector3d u2 = strained(stretch * n1.cross(e3) + stretch1 * n.cross(e3) - u1.cross(m) - u.cross(m1)),
                 u2_by_p = strained(-stretch * N.cross(e3));
  const Vector3d w = u.cross(e3), w1 = u1.cross(e3);  // t' = R w, t'' = R (u × w + w')
  const Vector3d third = u.cross(u.cross(w) + w1) + u1.cross(w) + u.cross(w1) + u2.cross(e3);
  return -N.dot(third) / N.dot(u2_by_p.cross(e3));
}

namespace {

constexpr int free_size = 10;  // r, q, m; n is a constant of the arc
constexpr int line_size = 14;  // r, q, m, n, ∫p; where the rod stretches or weighs its virial more

template <int N>
void put(double* place, const Eigen::Matrix<double, N, 1>& values) {
  Eigen::Map<Eigen::Matrix<double, N, 1>>{place} = values;
}

void check(int flag, const char* what) {
  if (flag < 0)
    throw std::runtime_error(std::string("CVODE: ") + what + " failed with flag " + std::to_string(flag));
}

}  // namespace

struct RodFlow::Memory {
  Stiffness stiffness;
  equilibrium::ArcKind kind;
  Shape shape;
  SUNContext context = nullptr;
  N_Vector state = nullptr;
  SUNNonlinearSolver iteration = nullptr;
  void* cvode = nullptr;
  Vector3d n = Vector3d::Zero();  // constant force of a free arc
  Vector3d origin =
      Vector3d::Zero();  // subtracted from r, so that tolerances do not scale with far positions
  double reached = 0.0, direction = 1.0;
  Eigen::VectorXd places, pressures;  // prescribed

  Memory(const Stiffness& law, equilibrium::ArcKind arc_kind, const Shape& below)
      : stiffness(law), kind(arc_kind), shape(below) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() {
    if (cvode != nullptr) CVodeFree(&cvode);
    if (iteration != nullptr) SUNNonlinSolFree(iteration);
    if (state != nullptr) N_VDestroy(state);
    if (context != nullptr) SUNContext_Free(&context);
  }

  bool on_surface() const { return kind == equilibrium::ArcKind::line; }
  bool loaded() const { return stiffness.stretches() || stiffness.weighs(); }
  int virial_at() const { return on_surface() ? line_size : free_size; }
  int size() const { return virial_at() + loaded(); }
  Section section(const double* y, double s) const;
  double pressure(const Section& x, double s) const;
  void rates(const double* y, double s, double* rate) const;
  void line_rates(const Section& x, double s, const Vector3d& slope, double* rate) const;
  static int right_hand_side(realtype s, N_Vector y, N_Vector rate, void* user) {
    static_cast<const Memory*>(user)->rates(N_VGetArrayPointer(y), s, N_VGetArrayPointer(rate));
    return 0;
  }
};

Section RodFlow::Memory::section(const double* y, double s) const {
  Section section;
  section.r = Eigen::Map<const Vector3d>(y) + origin;
  section.q = Eigen::Map<const Vector4d>(y + 3);
  section.m = Eigen::Map<const Vector3d>(y + 7);
  section.n =
      on_surface() ? Vector3d(Eigen::Map<const Vector3d>(y + 10)) : Vector3d(n - s * stiffness.weight);
  return section;
}

double RodFlow::Memory::pressure(const Section& x, double s) const {
  if (places.size() > 0) return polynomial(places, pressures, s);
  if (has_layers(stiffness, shape)) return taken_by_friction(x, stiffness) / layer_width(x, stiffness, shape);
  if (shape.wall()) return plane_pressure(x, stiffness, *shape.wall());
  return stiffness.stretches() ? stretched_surface_pressure(x, stiffness)
                               : surface_pressure(x, stiffness.K[0]);
}

void RodFlow::Memory::rates(const double* y, double s, double* rate) const {
  const Section x = section(y, s);
  const Vector3d t = tangent(x);
  const double stretch = stiffness.stretch(x);
  put<3>(rate, stretch * t);
  // q' = ½ q⊗(0,u): with q = (w, v) and u in the body frame, (-v·u, w u + v×u)/2
  const Vector3d u = stiffness.strain(x);
  const Vector3d v = x.q.tail<3>();
  rate[3] = -0.5 * v.dot(u);
  put<3>(rate + 4, 0.5 * (x.q[0] * u + v.cross(u)));
  put<3>(rate + 7, stretch * x.n.cross(t));
  if (loaded()) rate[virial_at()] = (stretch - 1.0) * x.n.dot(t) - 2.0 * stiffness.weight.dot(x.r);
  if (on_surface()) line_rates(x, s, stretch * t, rate);
  if (direction < 0.0)
    for (int i = 0; i < size(); ++i) rate[i] = -rate[i];
}

void RodFlow::Memory::line_rates(const Section& x, double s, const Vector3d& slope, double* rate) const {
  const double p = pressure(x, s);
  if (shape.has_couple()) {
    const Vector3d couple = shape.couple(x.r, slope);
    for (int i = 0; i < 3; ++i) rate[7 + i] -= p * couple(i);
  }
  put<3>(rate + 10, -p * shape.push(x.r, slope) - stiffness.weight);
  rate[13] = p;
}

RodFlow::RodFlow(const Stiffness& stiffness, equilibrium::ArcKind kind, double tolerance, const Shape& shape)
    : memory_(std::make_unique<Memory>(stiffness, kind, shape)) {
  Memory& memory = *memory_;
  check(SUNContext_Create(nullptr, &memory.context), "context");
  memory.state = N_VNew_Serial(memory.size(), memory.context);
  if (memory.state == nullptr) throw std::runtime_error("CVODE: no memory for the state");
  N_VConst(0.0, memory.state);
  // Adams: smooth, not stiff over the distance between two samples, and no Jacobian to get wrong
  memory.cvode = CVodeCreate(CV_ADAMS, memory.context);
  if (memory.cvode == nullptr) throw std::runtime_error("CVODE: no memory for the integrator");
  check(CVodeInit(memory.cvode, &Memory::right_hand_side, 0.0, memory.state), "initialisation");
  check(CVodeSStolerances(memory.cvode, tolerance, 0.1 * tolerance), "tolerances");
  check(CVodeSetUserData(memory.cvode, memory_.get()), "user data");
  check(CVodeSetMaxNumSteps(memory.cvode, 100000), "step limit");
  check(CVodeSetErrFile(memory.cvode, nullptr), "silence");
  memory.iteration = SUNNonlinSol_FixedPoint(memory.state, 0, memory.context);
  check(CVodeSetNonlinearSolver(memory.cvode, memory.iteration), "fixed-point iteration");
}

RodFlow::RodFlow(RodFlow&&) noexcept = default;
RodFlow& RodFlow::operator=(RodFlow&&) noexcept = default;
RodFlow::~RodFlow() = default;

void RodFlow::restart(const Section& start, bool backward) {
  Memory& memory = *memory_;
  memory.direction = backward ? -1.0 : 1.0;
  memory.n = start.n;
  memory.origin = memory.on_surface() && !on_wall() ? Vector3d(0.0, 0.0, start.r.z()) : start.r;
  double* y = N_VGetArrayPointer(memory.state);
  put<3>(y, start.r - memory.origin);
  put<4>(y + 3, start.q.normalized());
  put<3>(y + 7, start.m);
  if (memory.on_surface()) {
    put<3>(y + 10, start.n);
    y[13] = 0.0;
  }
  if (memory.loaded()) y[memory.virial_at()] = 0.0;
  memory.reached = 0.0;
  check(CVodeReInit(memory.cvode, 0.0, memory.state), "restart");
}

void RodFlow::prescribe(const Eigen::VectorXd& places, const Eigen::VectorXd& pressures) {
  memory_->places = places;
  memory_->pressures = pressures;
}

Section RodFlow::advance(double s) {
  Memory& memory = *memory_;
  if (s > memory.reached)
    check(CVode(memory.cvode, s, memory.state, &memory.reached, CV_NORMAL), "integration");
  return memory.section(N_VGetArrayPointer(memory.state), s);
}

double RodFlow::virial() const {
  return memory_->loaded() ? N_VGetArrayPointer(memory_->state)[memory_->virial_at()] : 0.0;
}

const Stiffness& RodFlow::stiffness() const { return memory_->stiffness; }

bool RodFlow::on_wall() const { return memory_->shape.wall().has_value(); }

double RodFlow::contact_force() const {
  return memory_->on_surface() ? N_VGetArrayPointer(memory_->state)[13] : 0.0;
}

}  // namespace windlass::verify
