! @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
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

  ! The one exported function.
  function fretwork_plugin() bind(c, name="fretwork_plugin") result(plugin)
    type(c_ptr) :: plugin
    if (.not. filled) then
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "thermal", "W/(N K)", "thermal conductance per force", 1e-3_c_double, 0.0_c_double, 1e30_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "electric", "S/N", "electrical conductance per force", 1.0_c_double, 0.0_c_double, 1e30_c_double)
      about(:, 1) = text("@NAME@")
      about(:, 2) = text("0.1.0")
      about(:, 3) = text("conductance in proportion to the force")
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
