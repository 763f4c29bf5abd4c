@HEAD@
  integer, parameter :: count = 2, longest = 100
@STORE@

  ! (1) D for the traction t0 (Pa) of the undamaged bond at the opening u (m); psi = (1 - D)^m
  ! psi_0.
  pure function damage(p, t0, u, m) result(d)
    real(c_double), intent(in) :: p(:), t0, u, m
    real(c_double) :: d, first, last
    first = p(1) * u / t0
    last = 2 * p(2) / p(1)
    if (t0 <= p(1)) then
      d = 0
    else if (u >= last .or. last <= first) then
      d = 1
    else
      d = 1 - (p(1) * (last - u) / (last - first) / t0)**(1 / m)
    end if
  end function damage

  ! (2) Area under the curve that `law certify` compares with, at any angle.
  function fracture_energy(values, angle) bind(c) result(energy)
    type(c_ptr), value :: values
    real(c_double), value :: angle
    real(c_double) :: energy
    real(c_double), pointer :: p(:)
    p => column(values, int(count, c_size_t))
    energy = p(2) + 0 * angle
  end function fracture_energy

  function commit(b, message) bind(c) result(status)
    type(fw_batch), intent(in) :: b
    type(fw_message), intent(inout) :: message
    integer(c_int32_t) :: status
    real(c_double), pointer :: p(:), n(:), t1(:), t2(:), before(:), energy(:), out(:)
    real(c_double) :: t0
    integer(c_size_t) :: k
    p => column(b%parameters, int(count, c_size_t))
    n => column(b%intact_n, b%n)
    t1 => column(b%intact_t1, b%n)
    t2 => column(b%intact_t2, b%n)
    before => column(b%damage, b%n)
    energy => column(b%energy_intact, b%n)
    out => column(b%out_damage, b%n)
    do k = 1, b%n
      t0 = max(n(k), 0.0_c_double)**2 + t1(k)**2
      if (size(t2) > 0) t0 = t0 + t2(k)**2
      t0 = sqrt(t0)
      out(k) = before(k)
      if (t0 > 0) out(k) = max(before(k), damage(p, t0, 2 * energy(k) / t0, b%degradation))
      if (.not. (ieee_is_finite(out(k)) .and. ieee_is_finite(t0))) then
        call tell(message, k, "the traction is not finite; take a smaller step")
        status = FW_ERROR
        return
      end if
    end do
    status = FW_OK
  end function commit

@TABLE@
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "strength", "Pa", "traction at which damage begins", 3e5_c_double, 1e-30_c_double, 1e30_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "energy", "J/m^2", "fracture energy: area under the traction-opening curve", 0.5_c_double, 1e-30_c_double, 1e30_c_double)
      about(:, 3) = text("linear softening")
      table%flags = 0
      table%commit = c_funloc(commit)
      table%fracture_energy = c_funloc(fracture_energy)
@END@
