@HEAD@
  integer, parameter :: count = 2, longest = 100
@STORE@

  ! (1) Normal force (N) from the normal impulse over the step (N s).
  pure function force(impulse, h)
    real(c_double), intent(in) :: impulse, h
    real(c_double) :: force
    force = max(impulse / h, 0.0_c_double)
  end function force

  ! (2) Conductance (W/K or S) under a normal force (N), from that per force.
  pure function conductance(per_force, force)
    real(c_double), intent(in) :: per_force, force
    real(c_double) :: conductance
    conductance = per_force * force
  end function conductance

  function commit(b, message) bind(c) result(status)
    type(fw_batch), intent(in) :: b
    type(fw_message), intent(inout) :: message
    integer(c_int32_t) :: status
    real(c_double), pointer :: p(:), impulse(:), heat(:), current(:)
    integer(c_size_t) :: k
    p => column(b%parameters, int(count, c_size_t))
    impulse => column(b%impulse_n, b%n)
    heat => column(b%out_conductance, b%n)
    current => column(b%out_electric_conductance, b%n)
    do k = 1, b%n
      heat(k) = conductance(p(1), force(impulse(k), b%h))
      current(k) = conductance(p(2), force(impulse(k), b%h))
      if (.not. ieee_is_finite(heat(k) + current(k))) then
        call tell(message, k, "the conductance is not finite")
        status = FW_ERROR
        return
      end if
    end do
    status = FW_OK
  end function commit

@TABLE@
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "thermal", "W/(N K)", "thermal conductance per force", 1e-3_c_double, 0.0_c_double, 1e30_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "electric", "S/N", "electrical conductance per force", 1.0_c_double, 0.0_c_double, 1e30_c_double)
      about(:, 3) = text("conductance in proportion to the force")
      table%flags = 0
      table%commit = c_funloc(commit)
@END@
