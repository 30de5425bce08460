! Free tail of a planar rod wound round the unit circle, for AUTO-07p.
!
! psi is the angle from the pull to the tangent, m the bending moment, both over the tail scaled to [0, 1]:
!
!   psi' = l m,   m' = l T sin(psi),   m(0) = -1 (the circle's curvature),  m(1) = 0 (free of moment).
!
! The rod is 2 H long and meets the pull at phi/2 on each side, so the tail has what the contact arc leaves over:
! l = H - (phi/2 - psi(0)). That makes the tail's equations those of the whole symmetric coil.
!
! PAR: 1 T, 2 phi, 3 H, 4 l (free, follows from psi(0)), 5 R_tot = 2 T (phi_star cos(psi_0) + sin(psi_0))

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: t, l

  t = par(1)
  l = par(4)
  f = (/ l*u(2), l*t*sin(u(1)) /)
  if (ijac == 0) return
  dfdu = reshape((/ 0d0, l*t*cos(u(1)), l, 0d0 /), (/ 2, 2 /))
  if (ijac == 1) return
  dfdp(:, 1) = (/ 0d0, l*sin(u(1)) /)
  dfdp(:, 4) = (/ u(2), t*sin(u(1)) /)
end subroutine func

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  double precision, parameter :: pi = 3.14159265358979323846d0
  double precision :: beta, decay

  ! The infinitely long tail in closed form: exact to exp(-2 sqrt(T) l), which the first step removes.
  par(1) = 5d0
  par(2) = 2*pi
  par(3) = 15d0
  beta = acos(1 - 0.5d0/par(1))
  par(4) = par(3) - (0.5d0*par(2) - beta)
  decay = tan(0.25d0*beta)*exp(-sqrt(par(1))*par(4)*t)
  u(1) = 4*atan(decay)
  u(2) = -2*sqrt(par(1))*sin(0.5d0*u(1))
end subroutine stpnt

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)

  fb = (/ u0(2) + 1, u1(2), par(4) - par(3) + 0.5d0*par(2) - u0(1) /)
  if (ijac == 0) return
  dbc(1:3, 1:4) = 0
  dbc(1, 2) = 1
  dbc(2, 4) = 1
  dbc(3, 1) = -1
  if (ijac == 1) return
  dbc(1:3, 5:9) = 0
  dbc(3, 6) = 0.5d0
  dbc(3, 7) = -1
  dbc(3, 8) = 1
end subroutine bcnd

subroutine pvls(ndim, u, par)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim)
  double precision, intent(inout) :: par(*)
  double precision, external :: getp
  double precision :: psi

  psi = getp('BV0', 1, u)
  par(5) = 2*par(1)*((0.5d0*par(2) - psi)*cos(psi) + sin(psi))
end subroutine pvls

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt
