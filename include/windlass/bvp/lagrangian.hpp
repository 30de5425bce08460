#pragma once

#include <Eigen/Dense>
#include <array>

#include "windlass/bvp/collocation_table.hpp"

namespace windlass::bvp {

/// Configurations that are plain coordinates: increments are added.
template <int N>
struct Coordinates {
  static constexpr int ambient = N, tangent = N;
  static constexpr double metric_scale = 1.0;
  using Q = Eigen::Matrix<double, N, 1>;

  static Eigen::Matrix<double, N, N> basis(const Q&) { return Eigen::Matrix<double, N, N>::Identity(); }
  static double radial(const Q&, const Q&) { return 0.0; }
  static Q normalised(const Q& q) { return q; }
};

/// Most sections that a density is asked about at once: the Lagrange points of an element.
inline constexpr int max_sections = max_stages + 2;

/// Sections where a density is evaluated: configurations of A numbers, forces of P.
template <int A, int P>
struct Sections {
  using Columns =
      Eigen::Matrix<double, A, Eigen::Dynamic, A == 1 ? Eigen::RowMajor : Eigen::ColMajor, A, max_sections>;
  using Force = Eigen::Matrix<double, P, 1>;

  int count = 0;
  Columns q, slope;  ///< configurations and q'; A × count
  std::array<Force, max_sections> n;
  bool falls = false;  ///< n differs from section to section; otherwise the first is that of all
  double compliance = 0.0;

  const Force& force(int k) const { return n[falls ? k : 0]; }
};

/// A Lagrangian density L(q, q', n) of a rod as the collocation of arcs sees it: asked about all sections of an element
/// at once, so that what follows from the sizes alone is compiled once for all densities of a size.
template <int A, int P>
class Lagrangian {
 public:
  struct First {
    double value;
    Eigen::Matrix<double, 2 * A, 1> gz;  ///< with (q, q')
    Eigen::Matrix<double, P, 1> d;       ///< −∂L/∂n
  };
  struct Second {
    Eigen::Matrix<double, 2 * A, 1> gz;
    Eigen::Matrix<double, 2 * A, 2 * A> hz;
    Eigen::Matrix<double, P, 1> d;
    Eigen::Matrix<double, P, A> d_q, d_slope;  ///< the second of a rod that stretches only
    Eigen::Matrix<double, P, P> d_n;           ///< of a rod that stretches only
  };

  virtual ~Lagrangian() = default;
  virtual bool stretches() const = 0;
  virtual void first(const Sections<A, P>& at, First* out) const = 0;
  virtual void second(const Sections<A, P>& at, Second* out) const = 0;
  /// Elastic energy per length.
  virtual void elastic(const Sections<A, P>& at, double* out) const = 0;
};

/// The density of a rod, a plain struct, behind that interface; for what it supplies see CollocationArc.
template <class Density>
class LagrangianOf final : public Lagrangian<Density::ambient, Density::forces> {
  static constexpr int A = Density::ambient, P = Density::forces;
  static constexpr bool stretching = requires { Density::stretches; };

 public:
  explicit LagrangianOf(const Density& density) : density_(density) {}

  bool stretches() const override { return stretching; }
  void first(const Sections<A, P>& at, typename Lagrangian<A, P>::First* out) const override;
  void second(const Sections<A, P>& at, typename Lagrangian<A, P>::Second* out) const override;
  void elastic(const Sections<A, P>& at, double* out) const override;

 private:
  Density density_;
};

template <class Density>
void LagrangianOf<Density>::first(const Sections<A, P>& at, typename Lagrangian<A, P>::First* out) const {
  for (int k = 0; k < at.count; ++k)
    if constexpr (stretching)
      out[k].value =
          density_.first(at.q.col(k), at.slope.col(k), at.force(k), at.compliance, out[k].gz, out[k].d);
    else
      out[k].value = density_.first(at.q.col(k), at.slope.col(k), at.force(k), out[k].gz, out[k].d);
}

template <class Density>
void LagrangianOf<Density>::second(const Sections<A, P>& at, typename Lagrangian<A, P>::Second* out) const {
  for (int k = 0; k < at.count; ++k) {
    auto& o = out[k];
    if constexpr (stretching)
      density_.second(at.q.col(k), at.slope.col(k), at.force(k), at.compliance, o.gz, o.hz, o.d, o.d_q,
                      o.d_slope, o.d_n);
    else
      density_.second(at.q.col(k), at.slope.col(k), at.force(k), o.gz, o.hz, o.d, o.d_q);
  }
}

template <class Density>
void LagrangianOf<Density>::elastic(const Sections<A, P>& at, double* out) const {
  for (int k = 0; k < at.count; ++k)
    if constexpr (stretching)
      out[k] = density_.elastic(at.q.col(k), at.slope.col(k), at.force(k), at.compliance);
    else
      out[k] = density_.elastic(at.q.col(k), at.slope.col(k));
}

}  // namespace windlass::bvp
