! @NAME@: a cohesion law for Fretwork. Fill in the two functions marked (1) and (2).
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

  ! (1) Remaining stiffness fraction "left" at damage D: traction = left k x, psi = left k x^2/2; with `degradation` m, (1 - D)^m.
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

  ! The one exported function.
  function fretwork_plugin() bind(c, name="fretwork_plugin") result(plugin)
    type(c_ptr) :: plugin
    if (.not. filled) then
      parameters(1) = schema(names(:, 1), units(:, 1), docs(:, 1), &
        "k_n", "Pa/m", "normal stiffness of the intact bond", 1e12_c_double, 1.0_c_double, 1e30_c_double)
      parameters(2) = schema(names(:, 2), units(:, 2), docs(:, 2), &
        "k_t", "Pa/m", "tangential stiffness of the intact bond", 1e12_c_double, 1.0_c_double, 1e30_c_double)
      about(:, 1) = text("@NAME@")
      about(:, 2) = text("0.1.0")
      about(:, 3) = text("linear bond")
      about(:, 4) = text("say where the equations come from")
      table%size = c_sizeof(table)
      table%abi_major = FW_ABI_MAJOR
      table%abi_minor = FW_ABI_MINOR
      table%kind = FW_KIND_@KINDUP@
      table%flags = ior(FW_FLAG_OPENING, ior(FW_FLAG_TENSION_ONLY, FW_FLAG_FORMS))
      table%name = c_loc(about(1, 1))
      table%version = c_loc(about(1, 2))
      table%doc = c_loc(about(1, 3))
      table%reference = c_loc(about(1, 4))
      table%n_parameters = count
      table%parameters = c_loc(parameters)
      table%degradation = 1
      table%prepare = c_funloc(prepare)
      table%energy = c_funloc(energy)
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
