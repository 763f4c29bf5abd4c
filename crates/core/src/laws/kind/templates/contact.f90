! @NAME@: a contact law for Fretwork. Fill in the two functions marked (1) and (2).
! fretwork.h documents the content and unit of every column, and when each call is made.
module law
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use fretwork
  implicit none
  private
  integer, parameter :: count = 3, longest = 100
  type(fw_field), target, save :: parameters(count)
  character(kind=c_char), target, save :: names(longest, count), units(longest, count), docs(longest, count)
  character(kind=c_char), target, save :: about(longest, 4)
  type(fw_plugin), target, save :: table
  logical, save :: filled = .false.

contains

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

  ! The one exported function.
  function fretwork_plugin() bind(c, name="fretwork_plugin") result(plugin)
    type(c_ptr) :: plugin
    if (.not. filled) then
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "mu_s", "", "friction coefficient at rest", 0.4_c_double, 0.0_c_double, 10.0_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "mu_d", "", "friction coefficient at high speed", 0.3_c_double, 0.0_c_double, 10.0_c_double)
      parameters(3) = schema(names(:, 3), units(:, 3), docs(:, 3), &
        "v", "m/s", "velocity over which it falls", 0.1_c_double, 1e-12_c_double, 1e30_c_double)
      about(:, 1) = text("@NAME@")
      about(:, 2) = text("0.1.0")
      about(:, 3) = text("friction that falls with the velocity")
      about(:, 4) = text("say where the equations come from")
      table%size = c_sizeof(table)
      table%abi_major = FW_ABI_MAJOR
      table%abi_minor = FW_ABI_MINOR
      table%kind = FW_KIND_@KINDUP@
      table%flags = 0
      table%name = c_loc(about(1, 1))
      table%version = c_loc(about(1, 2))
      table%doc = c_loc(about(1, 3))
      table%reference = c_loc(about(1, 4))
      table%n_parameters = count
      table%parameters = c_loc(parameters)
      table%prepare = c_funloc(prepare)
      filled = .true.
    end if
    plugin = c_loc(table)
  end function fretwork_plugin

  ! Null-terminated text.
  pure function text(words) result(out)
    character(*), intent(in) :: words
    character(kind=c_char) :: out(longest)
    integer :: i
    out = c_null_char
    do i = 1, min(len_trim(words), longest - 1)
      out(i) = words(i:i)
    end do
  end function text

  ! One line of the schema.
  function schema(name, unit, doc, name_text, unit_text, doc_text, default_value, minimum, maximum) result(f)
    character(kind=c_char), intent(inout), target :: name(longest), unit(longest), doc(longest)
    character(*), intent(in) :: name_text, unit_text, doc_text
    real(c_double), intent(in) :: default_value, minimum, maximum
    type(fw_field) :: f
    name = text(name_text)
    unit = text(unit_text)
    doc = text(doc_text)
    f = field(name, unit, doc, default_value, minimum, maximum)
  end function schema
end module law
