@HEAD@
  integer, parameter :: count = 2, longest = 100
@STORE@

  ! (1) Remaining stiffness fraction "left" at damage D: traction = left k x, psi = left k x^2/2;
  ! with `degradation` m, (1 - D)^m.
  pure function left(damage)
    real(c_double), intent(in) :: damage
    real(c_double) :: left
    left = 1 - damage
  end function left

  ! (2) Energy stored by the undamaged bond (J/m^2); a normal opening contributes only if positive.
  pure function stored(p, n, t)
    real(c_double), intent(in) :: p(:), n, t
    real(c_double) :: stored
    stored = 0.5_c_double * (p(1) * max(n, 0.0_c_double)**2 + p(2) * t**2)
  end function stored

  function prepare(b, message) bind(c) result(status)
    type(fw_batch), intent(in) :: b
    type(fw_message), intent(inout) :: message
    integer(c_int32_t) :: status
    real(c_double), pointer :: p(:), d(:), n(:), t1(:), t2(:), out_n(:), out_t1(:), out_t2(:), k_n(:), k_t(:)
    integer(c_size_t) :: k
    p => column(b%parameters, int(count, c_size_t))
    d => column(b%damage, b%n)
    n => column(b%opening_n, b%n)
    t1 => column(b%opening_t1, b%n)
    t2 => column(b%opening_t2, b%n)
    out_n => column(b%out_traction_n, b%n)
    out_t1 => column(b%out_traction_t1, b%n)
    out_t2 => column(b%out_traction_t2, b%n)
    k_n => column(b%out_stiffness_n, b%n)
    k_t => column(b%out_stiffness_t, b%n)
    do k = 1, b%n
      k_n(k) = left(d(k)) * p(1)
      k_t(k) = left(d(k)) * p(2)
      out_n(k) = k_n(k) * n(k)
      out_t1(k) = k_t(k) * t1(k)
      if (size(out_t2) > 0) out_t2(k) = k_t(k) * t2(k)
      if (.not. (ieee_is_finite(out_n(k)) .and. ieee_is_finite(out_t1(k)))) then
        call tell(message, k, "the traction is not finite")
        status = FW_ERROR
        return
      end if
    end do
    status = FW_OK
  end function prepare

  function energy(b, message) bind(c) result(status)
    type(fw_batch), intent(in) :: b
    type(fw_message), intent(inout) :: message
    integer(c_int32_t) :: status
    real(c_double), pointer :: p(:), d(:), n(:), t1(:), t2(:), out(:)
    real(c_double) :: t
    integer(c_size_t) :: k
    p => column(b%parameters, int(count, c_size_t))
    d => column(b%damage, b%n)
    n => column(b%opening_n, b%n)
    t1 => column(b%opening_t1, b%n)
    t2 => column(b%opening_t2, b%n)
    out => column(b%out_energy, b%n)
    do k = 1, b%n
      t = t1(k)
      if (size(t2) > 0) t = hypot(t, t2(k))
      out(k) = left(d(k)) * stored(p, n(k), t)
      if (.not. ieee_is_finite(out(k))) then
        call tell(message, k, "the energy is not finite")
        status = FW_ERROR
        return
      end if
    end do
    status = FW_OK
  end function energy

@TABLE@
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "k_n", "Pa/m", "normal stiffness of the intact bond", 1e12_c_double, 1.0_c_double, 1e30_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "k_t", "Pa/m", "tangential stiffness of the intact bond", 1e12_c_double, 1.0_c_double, 1e30_c_double)
      about(:, 3) = text("linear bond")
      table%flags = ior(FW_FLAG_OPENING, ior(FW_FLAG_TENSION_ONLY, FW_FLAG_FORMS))
      table%degradation = 1
      table%prepare = c_funloc(prepare)
      table%energy = c_funloc(energy)
@END@
