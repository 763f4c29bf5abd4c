@HEAD@
  integer, parameter :: count = 2, longest = 100
@STORE@

  ! (1) Normal force (N) from the normal impulse over the step (N s).
  pure function force(impulse, h)
    real(c_double), intent(in) :: impulse, h
    real(c_double) :: force
    force = max(impulse / h, 0.0_c_double)
  end function force

  ! (2) Volume removed (m^3) by a slip (m) under a normal force (N).
  pure function volume(p, force, slip)
    real(c_double), intent(in) :: p(:), force, slip
    real(c_double) :: volume
    volume = p(1) / p(2) * force * slip
  end function volume

  function commit(b, message) bind(c) result(status)
    type(fw_batch), intent(in) :: b
    type(fw_message), intent(inout) :: message
    integer(c_int32_t) :: status
    real(c_double), pointer :: p(:), impulse(:), slip(:), out(:)
    integer(c_size_t) :: k
    p => column(b%parameters, int(count, c_size_t))
    impulse => column(b%impulse_n, b%n)
    slip => column(b%slip, b%n)
    out => column(b%out_volume, b%n)
    do k = 1, b%n
      out(k) = volume(p, force(impulse(k), b%h), slip(k))
      if (.not. ieee_is_finite(out(k))) then
        call tell(message, k, "the volume is not finite")
        status = FW_ERROR
        return
      end if
    end do
    status = FW_OK
  end function commit

@TABLE@
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "k", "", "wear coefficient", 1e-4_c_double, 0.0_c_double, 1.0_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "hardness", "Pa", "hardness of the softer body", 3e9_c_double, 1.0_c_double, 1e30_c_double)
      about(:, 3) = text("volume proportional to force and slip")
      table%flags = 0
      table%commit = c_funloc(commit)
@END@
