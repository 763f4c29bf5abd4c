@HEAD@
  integer, parameter :: count = 3, longest = 100
@STORE@

  ! (1) Friction coefficient at a sliding velocity (m/s).
  pure function friction(p, speed)
    real(c_double), intent(in) :: p(:), speed
    real(c_double) :: friction
    friction = p(2) + (p(1) - p(2)) * exp(-speed / p(3))
  end function friction

  ! (2) Normal restitution, 0 to 1, at an approach velocity (m/s, negative approaches).
  pure function restitution(approach)
    real(c_double), intent(in) :: approach
    real(c_double) :: restitution
    restitution = merge(0.0_c_double, 0.0_c_double, approach < 0)
  end function restitution

  function prepare(b, message) bind(c) result(status)
    type(fw_batch), intent(in) :: b
    type(fw_message), intent(inout) :: message
    integer(c_int32_t) :: status
    real(c_double), pointer :: p(:), n(:), t1(:), t2(:), mu(:), e(:)
    real(c_double) :: speed
    integer(c_size_t) :: k
    p => column(b%parameters, int(count, c_size_t))
    n => column(b%velocity_n, b%n)
    t1 => column(b%velocity_t1, b%n)
    t2 => column(b%velocity_t2, b%n)
    mu => column(b%out_friction, b%n)
    e => column(b%out_restitution_n, b%n)
    do k = 1, b%n
      speed = abs(t1(k))
      if (size(t2) > 0) speed = hypot(t1(k), t2(k))
      mu(k) = friction(p, speed)
      e(k) = restitution(n(k))
      if (.not. ieee_is_finite(mu(k))) then
        call tell(message, k, "the friction is not finite")
        status = FW_ERROR
        return
      end if
    end do
    status = FW_OK
  end function prepare

@TABLE@
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "mu_s", "", "friction coefficient at rest", 0.4_c_double, 0.0_c_double, 10.0_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "mu_d", "", "friction coefficient at high speed", 0.3_c_double, 0.0_c_double, 10.0_c_double)
      parameters(3) = schema(names(:, 3), units(:, 3), docs(:, 3), &
        "v", "m/s", "velocity over which it falls", 0.1_c_double, 1e-12_c_double, 1e30_c_double)
      about(:, 3) = text("friction that falls with the velocity")
      table%flags = 0
      table%prepare = c_funloc(prepare)
@END@
