! @NAME@: a damage law for Fretwork. Fill in the two functions marked (1) and (2).
! fretwork.h documents the content and unit of every column, and when each call is made.
module law
  use, intrinsic :: iso_c_binding
  use, intrinsic :: ieee_arithmetic
  use fretwork
  implicit none
  private
  integer, parameter :: count = 2, longest = 100
  type(fw_field), target, save :: parameters(count)
  character(kind=c_char), target, save :: names(longest, count), units(longest, count), docs(longest, count)
  character(kind=c_char), target, save :: about(longest, 4)
  type(fw_plugin), target, save :: table
  logical, save :: filled = .false.

contains

  ! (1) D for the traction t0 (Pa) of the undamaged bond at the opening u (m); psi = (1 - D)^m psi_0.
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

  ! The one exported function.
  function fretwork_plugin() bind(c, name="fretwork_plugin") result(plugin)
    type(c_ptr) :: plugin
    if (.not. filled) then
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "strength", "Pa", "traction at which damage begins", 3e5_c_double, 1e-30_c_double, 1e30_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "energy", "J/m^2", "fracture energy: area under the traction-opening curve", 0.5_c_double, 1e-30_c_double, 1e30_c_double)
      about(:, 1) = text("@NAME@")
      about(:, 2) = text("0.1.0")
      about(:, 3) = text("linear softening")
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
      table%commit = c_funloc(commit)
      table%fracture_energy = c_funloc(fracture_energy)
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
