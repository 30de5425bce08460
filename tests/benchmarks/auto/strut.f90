! Clamped Kirchhoff strut of unit length, its ends pushed together and turned, for AUTO-07p.
!
! First-order Hamiltonian form, 14 states: place r (3), force n (3), unit quaternion q (4, body to world), its
! conjugate momentum mu (4), in the world frame, with the bodily moments m_i = mu.(q e_i)/2 and strains u_i = m_i/K_i:
!
!   r' = d3(q),  n' = 0,  q' = 1/2 sum u_i q e_i,  mu' = 1/2 sum u_i mu e_i - P d(n.d3)/dq + 2 eps e_x q,
!
! P the projection normal to q.!
! Left end at the origin, right end at (1 - d, 0, 0), tangents along e_x, the right end turned by tau about it. |q| and
! mu.q are conserved; q(0) gives the one, mu(1).q(1) = 0 the other. An isotropic strut may be turned about e_x as a
! whole: m_y(0) = 0 chooses the plane, and the torque eps about e_x, zero at every solution, balances the count.
!
! PAR: 1 d, 2 eps (free), 3 tau, 4 thrust = -n_x, 5 GJ/EI

module strut
  implicit none
  double precision, parameter :: pi = 3.14159265358979323846d0
contains
  pure function times_e(i, q) result(p)  ! q e_i
    integer, intent(in) :: i
    double precision, intent(in) :: q(4)
    double precision :: p(4)
    select case (i)
    case (1)
      p = (/ -q(2), q(1), q(4), -q(3) /)
    case (2)
      p = (/ -q(3), -q(4), q(1), q(2) /)
    case default
      p = (/ -q(4), q(3), -q(2), q(1) /)
    end select
  end function times_e

  pure function e_times(i, q) result(p)  ! e_i q
    integer, intent(in) :: i
    double precision, intent(in) :: q(4)
    double precision :: p(4)
    select case (i)
    case (1)
      p = (/ -q(2), q(1), -q(4), q(3) /)
    case (2)
      p = (/ -q(3), q(4), q(1), -q(2) /)
    case default
      p = (/ -q(4), -q(3), q(2), q(1) /)
    end select
  end function e_times

  pure function slope_d3(i, q) result(p)  ! gradient of d3_i with respect to q
    integer, intent(in) :: i
    double precision, intent(in) :: q(4)
    double precision :: p(4)
    select case (i)
    case (1)
      p = 2*(/ q(3), q(4), q(1), q(2) /)
    case (2)
      p = 2*(/ -q(2), -q(1), q(4), q(3) /)
    case default
      p = 2*(/ q(1), -q(2), -q(3), q(4) /)
    end select
  end function slope_d3

  pure function normal_slope(i, q) result(p)  ! its part normal to q
    integer, intent(in) :: i
    double precision, intent(in) :: q(4)
    double precision :: p(4)
    p = slope_d3(i, q)
    p = p - dot_product(p, q)*q
  end function normal_slope

  pure function outer(a, b) result(p)
    double precision, intent(in) :: a(4), b(4)
    double precision :: p(4, 4)
    p = spread(a, 2, 4)*spread(b, 1, 4)
  end function outer

  ! Frame of an end: d3 = e_x, turned by the angle tau about e_x.
  pure function end_frame(tau) result(q)
    double precision, intent(in) :: tau
    double precision :: q(4)
    q = sqrt(0.5d0)*(/ cos(0.5d0*tau), sin(0.5d0*tau), cos(0.5d0*tau), sin(0.5d0*tau) /)
  end function end_frame

  pure function slope_frame(tau) result(q)  ! derivative of end_frame
    double precision, intent(in) :: tau
    double precision :: q(4)
    q = 0.5d0*end_frame(tau + pi)
  end function slope_frame

  ! Clamped elastica of modulus k: sin(theta/2) = k sn(4 K s), thrust = (4 K)^2, d = 2 (1 - E/K). Arithmetic-geometric
  ! mean and descending Landen transformation (Abramowitz & Stegun 16.4, 17.6). slope = theta'.
  pure subroutine elastica(k, s, theta, slope, thrust, d)
    double precision, intent(in) :: k, s
    double precision, intent(out) :: theta, slope, thrust, d
    integer, parameter :: steps = 6
    double precision :: a(0:steps), c(0:steps), b, sum, phi
    integer :: n
    a(0) = 1
    b = sqrt(1 - k*k)
    c(0) = k
    sum = 0.5d0*k*k
    do n = 1, steps
      a(n) = 0.5d0*(a(n - 1) + b)
      c(n) = 0.5d0*(a(n - 1) - b)
      b = sqrt(a(n - 1)*b)
      sum = sum + 2d0**(n - 1)*c(n)**2
    end do
    thrust = (2*pi/a(steps))**2
    d = 2*sum
    phi = 2d0**steps*2*pi*s
    do n = steps, 1, -1
      phi = 0.5d0*(phi + asin(c(n)/a(n)*sin(phi)))
    end do
    theta = 2*asin(k*sin(phi))
    slope = 2*sqrt(thrust)*k*cos(phi)
  end subroutine elastica
end module strut

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use strut
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: q(4), mu(4), stiffness(3), strain, qe(4), me(4), unit(4, 4), half
  integer :: i, j

  q = u(7:10)
  mu = u(11:14)
  stiffness = (/ 1d0, 1d0, par(5) /)
  f(4:6) = 0
  f(7:10) = 0
  f(11:14) = 2*par(2)*e_times(1, q)
  do i = 1, 3
    f(i) = 0.5d0*dot_product(slope_d3(i, q), q)  ! d3 is quadratic in q
    qe = times_e(i, q)
    strain = 0.5d0*dot_product(mu, qe)/stiffness(i)
    f(7:10) = f(7:10) + 0.5d0*strain*qe
    f(11:14) = f(11:14) + 0.5d0*strain*times_e(i, mu) - u(3 + i)*normal_slope(i, q)
  end do
  if (ijac == 0) return

  dfdu = 0
  do j = 1, 4
    unit(:, j) = 0
    unit(j, j) = 1
    dfdu(11:14, 6 + j) = 2*par(2)*e_times(1, unit(:, j))
  end do
  do i = 1, 3
    dfdu(i, 7:10) = slope_d3(i, q)
    dfdu(11:14, 3 + i) = -normal_slope(i, q)
    dfdu(11:14, 7:10) = dfdu(11:14, 7:10) + 2*u(3 + i)*outer(q, slope_d3(i, q))
    qe = times_e(i, q)
    me = times_e(i, mu)
    half = 0.25d0/stiffness(i)
    strain = 0.5d0*dot_product(mu, qe)/stiffness(i)
    ! mu.(q e_i) = -q.(mu e_i)
    dfdu(7:10, 7:10) = dfdu(7:10, 7:10) - half*outer(qe, me)
    dfdu(7:10, 11:14) = dfdu(7:10, 11:14) + half*outer(qe, qe)
    dfdu(11:14, 7:10) = dfdu(11:14, 7:10) - half*outer(me, me)
    dfdu(11:14, 11:14) = dfdu(11:14, 11:14) + half*outer(me, qe)
    do j = 1, 4
      dfdu(7:10, 6 + j) = dfdu(7:10, 6 + j) + 0.5d0*strain*times_e(i, unit(:, j))
      dfdu(11:14, 10 + j) = dfdu(11:14, 10 + j) + 0.5d0*strain*times_e(i, unit(:, j))
      dfdu(11:14, 6 + j) = dfdu(11:14, 6 + j) - u(3 + i)*(slope_d3(i, unit(:, j)) - 2*f(i)*unit(:, j))
    end do
  end do
  if (ijac == 1) return
  dfdp(:, 1:3) = 0
  dfdp(11:14, 2) = 2*e_times(1, q)
end subroutine func

subroutine stpnt(ndim, u, par, t)
  use strut
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  double precision, parameter :: modulus = 0.1d0, gauss = 0.5d0/sqrt(3d0)
  integer, parameter :: panels = 60
  double precision :: theta, slope, frame(4), s
  integer :: i

  ! The planar elastica, bent a little in the plane z = 0, in closed form; places by two-point Gauss quadrature.
  par(2) = 0
  par(3) = 0
  par(5) = 2d0/3d0
  u(1:3) = 0
  do i = 1, 2*panels
    s = t*((i + 1)/2 - 0.5d0 + merge(gauss, -gauss, mod(i, 2) == 0))/panels
    call elastica(modulus, s, theta, slope, par(4), par(1))
    u(1:2) = u(1:2) + 0.5d0*t/panels*(/ cos(theta), sin(theta) /)
  end do
  call elastica(modulus, t, theta, slope, par(4), par(1))
  u(4:6) = (/ -par(4), 0d0, 0d0 /)
  frame = end_frame(0d0)
  u(7:10) = cos(0.5d0*theta)*frame + sin(0.5d0*theta)*e_times(3, frame)
  u(11:14) = 2*slope*e_times(3, u(7:10))
end subroutine stpnt

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  use strut
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  double precision :: held(4)
  integer :: i

  held = end_frame(par(3))
  fb(1:3) = u0(1:3)
  fb(4:7) = u0(7:10) - end_frame(0d0)
  fb(8) = dot_product(u0(11:14), e_times(2, u0(7:10)))
  fb(9:11) = u1(1:3) - (/ 1 - par(1), 0d0, 0d0 /)
  do i = 1, 3  ! vector part of conj(held) q
    fb(11 + i) = dot_product(times_e(i, held), u1(7:10))
  end do
  fb(15) = dot_product(u1(7:10), u1(11:14))
  if (ijac == 0) return

  dbc(1:nbc, 1:2*ndim) = 0
  do i = 1, 3
    dbc(i, i) = 1
    dbc(8 + i, ndim + i) = 1
    dbc(11 + i, ndim + 7:ndim + 10) = times_e(i, held)
  end do
  do i = 4, 7
    dbc(i, 3 + i) = 1
  end do
  dbc(8, 7:10) = -e_times(2, u0(11:14))
  dbc(8, 11:14) = e_times(2, u0(7:10))
  dbc(15, ndim + 7:ndim + 10) = u1(11:14)
  dbc(15, ndim + 11:ndim + 14) = u1(7:10)
  if (ijac == 1) return
  dbc(1:nbc, 2*ndim + 1:2*ndim + 5) = 0
  dbc(9, 2*ndim + 1) = 1
  do i = 1, 3
    dbc(11 + i, 2*ndim + 3) = dot_product(times_e(i, slope_frame(par(3))), u1(7:10))
  end do
end subroutine bcnd

subroutine pvls(ndim, u, par)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim)
  double precision, intent(inout) :: par(*)
  double precision, external :: getp

  par(4) = -getp('BV0', 4, u)
end subroutine pvls

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt
