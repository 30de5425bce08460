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
      u_hat(0.0, -rod.natural_curvature, rod.natural_twist) {}

Vector3d Stiffness::strain(const Section& section) const {
  return (rotation(section.q).transpose() * section.m).cwiseQuotient(K) + u_hat;
}

double Stiffness::energy_density(const Section& section) const {
  const Vector3d e = strain(section) - u_hat;
  return 0.5 * e.dot(K.cwiseProduct(e));
}

double Stiffness::hamiltonian(const Section& section) const {
  const Vector3d m_body = rotation(section.q).transpose() * section.m;
  return m_body.dot(strain(section)) - energy_density(section) + section.n.dot(tangent(section));
}

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

double plane_pressure(const Section& section, const Stiffness& stiffness, const Vector3d& normal) {
  const Eigen::Matrix3d to_body = rotation(section.q).transpose();
  const Vector3d m = to_body * section.m, n = to_body * section.n, N = to_body * normal,
                 e3 = Vector3d::UnitZ();
  const auto strained = [&](const Vector3d& moment) { return Vector3d(moment.cwiseQuotient(stiffness.K)); };
  const Vector3d u = stiffness.strain(section);
  const Vector3d m1 = n.cross(e3) - u.cross(m), u1 = strained(m1), n1 = -u.cross(n);
  const Vector3d u2 = strained(n1.cross(e3) - u1.cross(m) - u.cross(m1)), u2_by_p = strained(-N.cross(e3));
  const Vector3d w = u.cross(e3), w1 = u1.cross(e3);  // t' = R w, t'' = R (u × w + w')
  const Vector3d third = u.cross(u.cross(w) + w1) + u1.cross(w) + u.cross(w1) + u2.cross(e3);
  return -N.dot(third) / N.dot(u2_by_p.cross(e3));
}

namespace {

constexpr int free_size = 10;  // r, q, m; n is a constant of the arc
constexpr int line_size = 14;  // r, q, m, n, ∫p

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
  double reached = 0.0;

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
  Section section(const double* y) const;
  void rates(const double* y, double* rate) const;
  static int right_hand_side(realtype, N_Vector y, N_Vector rate, void* user) {
    static_cast<const Memory*>(user)->rates(N_VGetArrayPointer(y), N_VGetArrayPointer(rate));
    return 0;
  }
};

Section RodFlow::Memory::section(const double* y) const {
  Section section;
  section.r = Eigen::Map<const Vector3d>(y) + origin;
  section.q = Eigen::Map<const Vector4d>(y + 3);
  section.m = Eigen::Map<const Vector3d>(y + 7);
  section.n = on_surface() ? Vector3d(Eigen::Map<const Vector3d>(y + 10)) : n;
  return section;
}

void RodFlow::Memory::rates(const double* y, double* rate) const {
  const Section x = section(y);
  const Vector3d t = tangent(x);
  put<3>(rate, t);
  // q' = ½ q⊗(0,u): with q = (w, v) and u in the body frame, (-v·u, w u + v×u)/2
  const Vector3d u = stiffness.strain(x);
  const Vector3d v = x.q.tail<3>();
  rate[3] = -0.5 * v.dot(u);
  put<3>(rate + 4, 0.5 * (x.q[0] * u + v.cross(u)));
  put<3>(rate + 7, x.n.cross(t));
  if (!on_surface()) return;
  const double p =
      shape.wall() ? plane_pressure(x, stiffness, *shape.wall()) : surface_pressure(x, stiffness.K[0]);
  put<3>(rate + 10, -p * shape.push(x.r, t));
  rate[13] = p;
}

RodFlow::RodFlow(const Stiffness& stiffness, equilibrium::ArcKind kind, double tolerance, const Shape& shape)
    : memory_(std::make_unique<Memory>(stiffness, kind, shape)) {
  Memory& memory = *memory_;
  check(SUNContext_Create(nullptr, &memory.context), "context");
  memory.state = N_VNew_Serial(memory.on_surface() ? line_size : free_size, memory.context);
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

void RodFlow::restart(const Section& start) {
  Memory& memory = *memory_;
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
  memory.reached = 0.0;
  check(CVodeReInit(memory.cvode, 0.0, memory.state), "restart");
}

Section RodFlow::advance(double s) {
  Memory& memory = *memory_;
  if (s > memory.reached)
    check(CVode(memory.cvode, s, memory.state, &memory.reached, CV_NORMAL), "integration");
  return memory.section(N_VGetArrayPointer(memory.state));
}

bool RodFlow::on_wall() const { return memory_->shape.wall().has_value(); }

double RodFlow::contact_force() const {
  return memory_->on_surface() ? N_VGetArrayPointer(memory_->state)[13] : 0.0;
}

}  // namespace windlass::verify
