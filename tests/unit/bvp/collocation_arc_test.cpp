// Arcs as generating functions: derivatives against differences of the action, condensation against dense algebra.
#include "windlass/bvp/collocation_arc.hpp"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "windlass/chain/guess.hpp"
#include "windlass/rod/extensible_density.hpp"
#include "windlass/rod/kirchhoff_density.hpp"
#include "windlass/rod/planar_density.hpp"
#include "windlass/rod/surface_density.hpp"

namespace {

using namespace windlass;
using bvp::Arc;
using bvp::ArcPoint;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An arc with a smooth state that is no equilibrium: z holds q_a, the interior, q_b (ambient), n and the length.
struct State {
  std::unique_ptr<Arc> arc;
  VectorXd z;
  double compliance = 0.0;  ///< of arcs that stretch, which have a weight, too
  VectorXd weight = {};

  int nodes() const { return arc->interior_nodes() + 2; }
  ArcPoint point(const VectorXd& at) const {
    const int a = arc->ambient();
    ArcPoint p{at.data(), at.data() + (nodes() - 1) * a, at.data() + a, at.data() + nodes() * a,
               at(at.size() - 1)};
    p.compliance = compliance;
    p.weight = weight.size() > 0 ? weight.data() : nullptr;
    return p;
  }
  /// z moved by an increment ordered as the arc's own: interior, q_a, q_b, n, ℓ.
  VectorXd moved(const VectorXd& dz) const {
    VectorXd out = z;
    const int a = arc->ambient(), d = arc->tangent();
    for (int k = 0; k < nodes(); ++k) {
      const int place = k == 0             ? arc->interior_tangent()
                        : k == nodes() - 1 ? arc->interior_tangent() + d
                                           : (k - 1) * d;
      if (a == 4)
        out.segment<4>(4 * k) = rod::retract(z.segment<4>(4 * k), dz.segment<3>(place));
      else
        out.segment(k * a, a) += dz.segment(place, d);
    }
    out.tail(arc->forces() + 1) += dz.tail(arc->forces() + 1);
    return out;
  }
  /// S = ∫ W − n·d ds, of an arc without weight.
  double action(const VectorXd& at) const {
    const ArcPoint p = point(at);
    const Eigen::Map<const VectorXd> n(p.n, arc->forces());
    return arc->energy(p) - n.dot(arc->sample(p).displacement.rightCols<1>().col(0));
  }
  Eigen::Index size() const { return arc->interior_tangent() + arc->ends(); }
};

template <class Density>
State state(const Density& density, int stages) {
  State out{bvp::make_collocation_arc(density, {0.0, 0.3, 0.45, 1.0}, stages), {}};
  const int a = out.arc->ambient(), nodes = out.nodes();
  out.z.resize(nodes * a + out.arc->forces() + 1);
  for (int k = 0; k < nodes; ++k) {
    const double s = static_cast<double>(k) / (nodes - 1);
    if (a == 4)
      out.z.segment<4>(4 * k) =
          Eigen::Vector4d(1.0 + 0.2 * s, 0.3 * std::sin(2.0 * s), 0.2 - 0.5 * s * s, 0.4 * s).normalized();
    else
      for (int i = 0; i < a; ++i) out.z(k * a + i) = 0.4 * std::sin(1.5 * s + i) - 0.2 * i * s;
  }
  for (int i = 0; i < out.arc->forces(); ++i) out.z(nodes * a + i) = 0.8 - 0.7 * i;
  out.z(out.z.size() - 1) = 1.3;
  return out;
}

std::vector<State> states(int stages) {
  std::vector<State> all;
  all.push_back(state(rod::PlanarDensity{1.4}, stages));
  all.push_back(state(rod::SurfaceDensity{1.2, 0.7}, stages));
  all.push_back(state(rod::KirchhoffDensity{{1.0, 1.5, 0.6}, {0.1, -0.2, 0.3}}, stages));
  const auto stretching = [&](State one) {
    one.compliance = 0.2;
    all.push_back(std::move(one));
  };
  stretching(state(rod::Extensible<rod::PlanarDensity>{{1.4, 0.2}}, stages));
  stretching(state(rod::Extensible<rod::SurfaceDensity>{{1.2, 0.7}}, stages));
  stretching(state(rod::Extensible<rod::PlaneDensity>{{{1.0, 1.5, 0.6}, {0.1, -0.2, 0.3}}}, stages));
  stretching(state(rod::Extensible<rod::KirchhoffDensity>{{{1.0, 1.5, 0.6}, {0.1, -0.2, 0.3}}}, stages));
  return all;
}

MatrixXd dense_hessian(const State& s) {
  std::vector<Eigen::Triplet<double>> entries;
  s.arc->hessian(s.point(s.z), entries);
  MatrixXd h = MatrixXd::Zero(s.size(), s.size());
  for (const auto& e : entries) h(e.row(), e.col()) += e.value();
  return h;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(collocation_arc)

BOOST_AUTO_TEST_CASE(gradient_is_that_of_the_action) {
  for (const State& s : states(3)) {
    VectorXd gradient(s.size());
    bvp::EndsVector ends;
    s.arc->gradient(s.point(s.z), gradient.data(), ends);
    gradient.tail(s.arc->ends()) = ends;
    constexpr double h = 1e-5;  // differences err by h² and by 1e-16/h
    for (Eigen::Index k = 0; k < s.size(); ++k) {
      const VectorXd step = h * VectorXd::Unit(s.size(), k);
      const double difference = (s.action(s.moved(step)) - s.action(s.moved(-step))) / (2.0 * h);
      BOOST_TEST_CONTEXT("configurations of " << s.arc->ambient() << " numbers, unknown " << k)
      BOOST_TEST(std::abs(gradient(k) - difference) < 1e-8);
    }
  }
}

BOOST_AUTO_TEST_CASE(hessian_is_the_second_derivative_of_the_action) {
  for (const State& s : states(3)) {
    const MatrixXd h = dense_hessian(s);
    BOOST_TEST((h - h.transpose()).norm() < 1e-13 * h.norm());
    std::srand(5);
    for (int sample = 0; sample < 10; ++sample) {
      const VectorXd v = VectorXd::Random(s.size());
      constexpr double step = 3e-4;  // fourth derivatives times step², and 1e-16/step²
      const double second =
          (s.action(s.moved(step * v)) - 2.0 * s.action(s.z) + s.action(s.moved(-step * v))) / (step * step);
      BOOST_TEST_CONTEXT("configurations of " << s.arc->ambient() << " numbers")
      BOOST_TEST(std::abs(v.dot(h * v) - second) < 1e-5 * h.norm() * v.squaredNorm());
    }
  }
}

BOOST_AUTO_TEST_CASE(hessian_is_the_slope_of_the_gradient_where_the_force_falls_along_the_arc) {
  for (State& s : states(3)) {
    if (s.compliance == 0.0) continue;
    s.weight = VectorXd::LinSpaced(s.arc->forces(), 0.7, -0.4);
    const MatrixXd h = dense_hessian(s);
    const auto gradient = [&](const VectorXd& at) {
      VectorXd all(s.size());
      bvp::EndsVector ends;
      s.arc->gradient(s.point(at), all.data(), ends);
      all.tail(s.arc->ends()) = ends;
      return all;
    };
    // Frames do not commute: of their rows the action along a line, v·h v, is compared, of the others all.
    const bool frames = s.arc->ambient() == 4;
    std::srand(7);
    for (int sample = 0; sample < 10; ++sample) {
      VectorXd v = VectorXd::Random(s.size());
      if (frames) v.head(s.size() - s.arc->forces() - 1).setZero();
      constexpr double step = 1e-5;  // differences err by step² and by 1e-16/step
      const VectorXd difference = (gradient(s.moved(step * v)) - gradient(s.moved(-step * v))) / (2.0 * step);
      BOOST_TEST_CONTEXT("configurations of " << s.arc->ambient() << " numbers")
      BOOST_TEST((h * v - difference).norm() < 1e-7 * h.norm());
    }
  }
}

BOOST_AUTO_TEST_CASE(condensation_is_dense_elimination) {
  for (const int stages : {2, 5})
    for (const State& s : states(stages)) {
      const MatrixXd h = dense_hessian(s);
      const Eigen::Index i = s.arc->interior_tangent(), e = s.arc->ends();
      bvp::EndsMatrix condensed;
      s.arc->factor(s.point(s.z), condensed);
      const MatrixXd inner = h.topLeftCorner(i, i), cross = h.bottomLeftCorner(e, i);
      const MatrixXd schur =
          h.bottomRightCorner(e, e) - cross * inner.partialPivLu().solve(cross.transpose());
      BOOST_TEST_CONTEXT("configurations of " << s.arc->ambient() << " numbers, stages " << stages) {
        BOOST_TEST((MatrixXd(condensed) - schur).norm() < 1e-10 * h.norm());
        BOOST_TEST(s.arc->negative_pivots() ==
                   (Eigen::SelfAdjointEigenSolver<MatrixXd>(inner).eigenvalues().array() < 0.0).count());
        std::srand(9);
        const VectorXd f = VectorXd::Random(i);
        VectorXd interior = f;
        bvp::EndsVector ends = bvp::EndsVector::Zero(e);
        s.arc->reduce(interior.data(), ends);
        const VectorXd reduced = -cross * inner.partialPivLu().solve(f);
        BOOST_TEST((VectorXd(ends) - reduced).norm() < 1e-10 * h.norm());
        const bvp::EndsVector y = bvp::EndsVector::Random(e);
        s.arc->expand(interior.data(), y);
        const VectorXd expected = inner.partialPivLu().solve(f - cross.transpose() * VectorXd(y));
        BOOST_TEST((interior - expected).norm() < 1e-10 * expected.norm());
      }
    }
}

BOOST_AUTO_TEST_SUITE_END()
